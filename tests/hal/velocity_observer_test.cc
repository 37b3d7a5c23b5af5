// SPDX-License-Identifier: Apache-2.0
#include "hal/velocity_observer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/support/no_alloc.h"

namespace tact::hal::velocity_observer_test {

constexpr double kBandwidth_Hz = 30.0;
constexpr double kTick_s = 1e-3;
constexpr double kQuantum_m = 0.0236e-3;

TEST(VelocityObserver, RestGivesZero) {
  VelocityObserver observer(kBandwidth_Hz, kJump_mps);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(observer.step({0.1, -0.2, 0.3}, kTick_s), Vec3{});
}

TEST(VelocityObserver, TracksConstantVelocityWithoutBiasAtUnevenTimes) {
  VelocityObserver observer(kBandwidth_Hz, kJump_mps);
  const Vec3 v{0.3, -0.1, 0.02};
  double t = 0.0;
  Vec3 seen;
  for (int i = 0; i < 600; ++i) {
    const double dt = (i % 3 == 0 ? 2.0 : 0.5) * kTick_s;
    t += dt;
    seen = observer.step(t * v, dt);
  }
  EXPECT_LT(norm(seen - v), 1e-9);
}

TEST(VelocityObserver, ArrivesAfterTheDelayItStates) {
  // At constant acceleration a the delay 2/w shows as a velocity error of 2 a / w.
  VelocityObserver observer(kBandwidth_Hz, 100.0);
  const double a = 2.0, w = 2.0 * std::numbers::pi * kBandwidth_Hz;
  double t = 0.0, error = 0.0;
  for (int i = 0; i < 500; ++i, t += kTick_s)
    error = a * t - observer.step({0.5 * a * t * t, 0.0, 0.0}, kTick_s).x;
  EXPECT_NEAR(error, a * 2.0 / w, a * kTick_s);
}

TEST(VelocityObserver, OneQuantumDisturbsLessThanItsBound) {
  // |error| <= w D / e = 1.64 mm/s for any slow ramp; differences give D / T = 23.6 mm/s.
  const double bound_mps = 2.0 * std::numbers::pi * kBandwidth_Hz * kQuantum_m / std::numbers::e;
  double worst_mps = 0.0, worst_difference_mps = 0.0;
  for (const double v : {0.0007, 0.0031, 0.0087, 0.0117, 0.0236, 0.0411}) {
    VelocityObserver observer(kBandwidth_Hz, kJump_mps);
    double last_m = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const double counted_m = kQuantum_m * std::floor(v * i * kTick_s / kQuantum_m + 0.5);
      const double seen_mps = observer.step({counted_m, 0.0, 0.0}, kTick_s).x;
      if (i > 200) {
        worst_mps = std::max(worst_mps, std::abs(seen_mps - v));
        worst_difference_mps =
            std::max(worst_difference_mps, std::abs((counted_m - last_m) / kTick_s - v));
      }
      last_m = counted_m;
    }
  }
  EXPECT_LE(worst_mps, bound_mps);
  EXPECT_GE(worst_mps, 0.3 * bound_mps);  // the bound is not idle
  EXPECT_GE(worst_difference_mps, 0.020);
}

TEST(VelocityObserver, AJumpIsNeverReportedAsSlow) {
  for (const double tick_s : {1e-2, 4e-3, 1e-3, 2.5e-4}) {
    VelocityObserver observer(kBandwidth_Hz, kJump_mps);
    for (int i = 0; i < 100; ++i) observer.step({0.1 * i * tick_s, 0.0, 0.0}, tick_s);
    const double from_m = 0.1 * 99 * tick_s;
    EXPECT_GT(observer.step({from_m + 0.1, 0.0, 0.0}, tick_s).x, 0.09 / tick_s);
    EXPECT_GT(observer.step({from_m + 0.2, 0.0, 0.0}, tick_s).x, 0.09 / tick_s);
  }
}

// Gaps of samples, too: 0.8 m/s from one tick to the next, as of a hand that slips.
TEST(VelocityObserver, AHardStartIsReportedWithinKJumpAtAnyRateAndAfterAnyGap) {
  for (const double tick_s : {1e-2, 4e-3, 1e-3, 2.5e-4})
    for (const int missed : {0, 1, 5, 19}) {
      VelocityObserver observer(kBandwidth_Hz, kJump_mps);
      for (int i = 0; i < 100; ++i) observer.step({}, tick_s);
      const double gap_s = (1 + missed) * tick_s;
      EXPECT_NEAR(observer.step({0.8 * gap_s, 0.0, 0.0}, gap_s).x, 0.8, 1e-9);
      VelocityObserver slower(kBandwidth_Hz, kJump_mps);
      for (int i = 0; i < 100; ++i) slower.step({}, tick_s);
      EXPECT_GE(slower.step({0.49 * gap_s, 0.0, 0.0}, gap_s).x, 0.0);
    }
}

TEST(VelocityObserver, NanGivesZeroAndIsForgotten) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  VelocityObserver observer(kBandwidth_Hz, kJump_mps);
  for (int i = 0; i < 100; ++i) observer.step({0.1 * i * kTick_s, 0.0, 0.0}, kTick_s);
  EXPECT_EQ(observer.step({nan, 0.0, 0.0}, kTick_s), Vec3{});
  EXPECT_EQ(observer.step({0.01, 0.0, 0.0}, kTick_s), Vec3{});
  const Vec3 kept = observer.step({0.0101, 0.0, 0.0}, kTick_s);
  EXPECT_GT(kept.x, 0.0);
  EXPECT_EQ(observer.step({0.0102, 0.0, 0.0}, 0.0), kept);
  EXPECT_EQ(observer.step({0.0102, 0.0, 0.0}, nan), kept);
}

TEST(VelocityObserver, FollowsACountedHandMotionBetterThanDifferences) {
  std::ifstream stream(TACT_SOURCE_DIR "/tests/data/vectors/kinematics_trajectory.json");
  ASSERT_TRUE(stream);
  const auto file = nlohmann::json::parse(stream);
  VelocityObserver observer(40.0, kJump_mps);
  const auto vec = [](const nlohmann::json& v) { return Vec3{v[0], v[1], v[2]}; };
  const double dt = file.at("dt");
  double observed = 0.0, differenced = 0.0;
  int count = 0;
  Vec3 last;
  for (const auto& row : file.at("rows")) {
    const Vec3 p = vec(row.at("p_from_counts")), v = vec(row.at("v_true"));
    const Vec3 seen = observer.step(p, dt);
    if (row.at("t").get<double>() > 0.1) {  // after the start from rest has ramped down
      observed += dot(seen - v, seen - v);
      differenced += dot((p - last) / dt - v, (p - last) / dt - v);
      ++count;
    }
    last = p;
  }
  // This hand swings at 1 to 2 Hz with 1 m/s: what remains is the delay 2/w = 8 ms, bounded both
  // ways.
  EXPECT_LT(std::sqrt(observed / count), 0.15);
  EXPECT_GT(std::sqrt(observed / count), 0.01);
  EXPECT_GT(std::sqrt(differenced / count), 0.005);
}

TEST(VelocityObserver, LeavesTheHeapAlone) {
  VelocityObserver observer(kBandwidth_Hz, kJump_mps);
  tests::NoAlloc guard;
  (void)observer.step({0.1, 0.0, 0.0}, kTick_s);
  (void)observer.step({0.1001, 0.0, 0.0}, kTick_s);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::velocity_observer_test
