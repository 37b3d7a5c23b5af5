// SPDX-License-Identifier: Apache-2.0
#include "host/pose/one_euro.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/tracking_views.h"

namespace tact::host::pose::one_euro_test {

using Eigen::Vector3d;

Pose at(double x_m) { return {.position_m = {x_m, 0.0, 0.0}}; }

TEST(OneEuro, MatchesPenAndPaper) {
  // f = 1 / (2 pi) Hz, T = 1 s: alpha = 1 / (1 + 1) = 1/2.
  EXPECT_NEAR(smoothing_share(0.5 / std::numbers::pi, 1.0), 0.5, 1e-15);
  // f_min = f_d = 1 / (2 pi), beta = 1 / (2 pi): x' = (1 - 0) / 2, f_c = (1 + 1/2) / (2 pi),
  // alpha = 1 / (1 + 1 / 1.5) = 0.6. Then x' = (1/2 + (1 - 0.6)) / 2 = 0.45, alpha = 1.45 / 2.45.
  const double f = 0.5 / std::numbers::pi;
  const OneEuroSettings settings{
      .least_cutoff_Hz = f, .speed_gain_per_unit = f, .speed_cutoff_Hz = f};
  PoseFilter filter(settings, settings);
  EXPECT_EQ(filter.next(at(0.0), 0.0).position_m.x(), 0.0);
  EXPECT_NEAR(filter.next(at(1.0), 1.0).position_m.x(), 0.6, 1e-15);
  EXPECT_NEAR(filter.next(at(1.0), 2.0).position_m.x(), 0.6 + 0.4 * 1.45 / 2.45, 1e-15);
}

TEST(OneEuro, ARotationFollowsTheSameEquations) {
  const double f = 0.5 / std::numbers::pi;
  const OneEuroSettings settings{
      .least_cutoff_Hz = f, .speed_gain_per_unit = f, .speed_cutoff_Hz = f};
  PoseFilter filter(settings, settings);
  const auto turned = [](double angle_rad) {
    return Pose{.rotation = test::turn(angle_rad, {0.0, 0.6, 0.8})};
  };
  const auto angle = [](const Pose& pose) {
    return pose.rotation.angularDistance(Eigen::Quaterniond::Identity());
  };
  filter.next(turned(0.0), 0.0);
  EXPECT_NEAR(angle(filter.next(turned(1.0), 1.0)), 0.6, 1e-12);
  Pose minus = turned(1.0);  // the same turn, written the other way round
  minus.rotation.coeffs() *= -1.0;
  EXPECT_NEAR(angle(filter.next(minus, 2.0)), 0.6 + 0.4 * 1.45 / 2.45, 1e-12);
}

TEST(OneEuro, ABodyAtRestIsCalmedAndAFastOneIsFollowed) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.005);
  PoseFilter filter;
  double raw_m2 = 0.0, shown_m2 = 0.0;
  for (int i = 0; i < 1200; ++i) {
    const double raw_m = noise(random), shown_m = filter.next(at(raw_m), i / 60.0).position_m.x();
    if (i < 120) continue;
    raw_m2 += raw_m * raw_m;
    shown_m2 += shown_m * shown_m;
  }
  EXPECT_LT(shown_m2, 0.2 * raw_m2);
  double last_m = 0.0;
  for (int i = 0; i < 120; ++i) last_m = filter.next(at(i / 60.0), 100.0 + i / 60.0).position_m.x();
  EXPECT_NEAR(last_m, 119.0 / 60.0, 0.03);  // 1 m/s: less than 30 ms behind
}

TEST(OneEuro, StartsAgainAfterAResetOrAStepBackInTime) {
  PoseFilter filter;
  filter.next(at(0.0), 10.0);
  EXPECT_EQ(filter.next(at(1.0), 9.0).position_m.x(), 1.0);
  EXPECT_EQ(filter.next(at(3.0), 9.0).position_m.x(), 3.0);
  filter.reset();
  EXPECT_EQ(filter.next(at(2.0), 11.0).position_m.x(), 2.0);
}

}  // namespace tact::host::pose::one_euro_test
