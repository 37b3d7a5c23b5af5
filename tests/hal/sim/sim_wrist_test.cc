// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/sim_wrist.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "model/units.h"

namespace tact::hal::sim::sim_wrist_test {

using model::operator""_deg;

constexpr double kStep_s = 0.25e-3;
constexpr WristPull kHand{
    .stiffness_Nm_per_rad = 1.0, .damping_Nms_per_rad = 0.02, .aim_rad = {0.1, -0.05, 0.02}};

TEST(SimWrist, TurnsToTheHandAndGivesWayToTorque) {
  SimWrist wrist({});
  for (int i = 0; i < 8000; ++i) wrist.step(kStep_s, {}, kHand);
  EXPECT_LT(norm(wrist.angles_rad() - kHand.aim_rad), 1e-9);
  for (int i = 0; i < 8000; ++i) wrist.step(kStep_s, {0.05, 0.0, 0.0}, kHand);
  EXPECT_NEAR(wrist.angles_rad().x, 0.1 + 0.05 / 1.0, 1e-9);  // T / k
}

TEST(SimWrist, StopsAtTwentyDegreesEachWay) {
  SimWrist wrist({});
  for (int i = 0; i < 8000; ++i) wrist.step(kStep_s, {0.2, -0.2, 0.2}, {});
  EXPECT_DOUBLE_EQ(wrist.angles_rad().x, 20_deg);
  EXPECT_DOUBLE_EQ(wrist.angles_rad().y, -20_deg);
  EXPECT_DOUBLE_EQ(wrist.angles_rad().z, 20_deg);
}

TEST(SimWrist, AnglesAndOrientationAreTheSameRotation) {
  const model::Vec3 turned_rad{0.2, -0.15, 0.1};
  const model::Vec3 angles = wrist_angles_rad(turned_rad);
  const Quat want = model::quat_from_rotation_vector(turned_rad);
  const Quat got = wrist_orientation(angles);
  EXPECT_NEAR(got.w, want.w, 1e-15);
  EXPECT_NEAR(got.x, want.x, 1e-15);
  EXPECT_NEAR(got.y, want.y, 1e-15);
  EXPECT_NEAR(got.z, want.z, 1e-15);
}

TEST(SimWrist, AngularVelocityIsTheRateOfTheOrientation) {
  const model::Vec3 angles{0.2, -0.3, 0.1}, rates{1.0, -2.0, 0.5};
  const double h = 1e-6;
  const Quat before = wrist_orientation(angles - h * rates);
  const Quat after = wrist_orientation(angles + h * rates);
  // q(t + h) q(t - h)^-1 is a turn by 2 h omega
  const Quat turn = after * conjugate(before);
  const model::Vec3 omega{turn.x / h, turn.y / h, turn.z / h};
  EXPECT_LT(norm(omega - wrist_angular_velocity_radps(angles, rates)), 1e-8);
}

TEST(SimWrist, AimsBeyondTheRangeAreBroughtInside) {
  const model::Vec3 angles = wrist_angles_rad({1.5, 0.0, 0.0});
  EXPECT_DOUBLE_EQ(angles.x, 20_deg);
  EXPECT_TRUE(is_finite(wrist_angles_rad({std::numeric_limits<double>::infinity(), 0.0, 0.0})));
}

TEST(SimWrist, NanStopsItInsteadOfSpreading) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SimWrist wrist({0.1, 0.0, 0.0});
  wrist.step(kStep_s, {nan, nan, nan}, kHand);
  EXPECT_EQ(wrist.angles_rad(), (model::Vec3{0.1, 0.0, 0.0}));
}

}  // namespace tact::hal::sim::sim_wrist_test
