// SPDX-License-Identifier: Apache-2.0
#include "firmware/gate/limits_for.h"

#include <gtest/gtest.h>

#include <limits>

namespace tact::firmware::gate::limits_for_test {

model::Limits scene() {
  model::Limits limits;
  limits.force_N = 4.0;
  limits.torque_Nm = 0.2;
  limits.workspace_radius_m = 0.10;
  limits.workspace_half_length_m = 0.08;
  return limits;
}
hal::DeviceInfo device(double times) {
  hal::DeviceInfo info{.name = {}, .grip = hal::GripKind::kNone};
  info.max_force_N = times * 4.0;
  info.max_torque_Nm = times * 0.2;
  info.workspace_radius_m = times * 0.10;
  info.workspace_half_length_m = times * 0.08;
  return info;
}

TEST(LimitsFor, AScaleOfTheMotionLimitsTheForceOnTheHand) {
  hal::DeviceInfo info = device(100.0);
  info.motion_scale = 4.0;
  const model::Limits limits = limits_for(scene(), info);
  EXPECT_DOUBLE_EQ(limits.force_N, 0.25 * scene().force_N) << "the hand gets four times of it";
  EXPECT_DOUBLE_EQ(limits.slew_N_per_s, 0.25 * scene().slew_N_per_s);
  EXPECT_DOUBLE_EQ(limits.continuous_force_N, 0.25 * scene().continuous_force_N);
  info.motion_scale = 0.5;
  EXPECT_DOUBLE_EQ(limits_for(scene(), info).force_N, scene().force_N) << "it gets half of it";
}

TEST(LimitsFor, TheFingersBearWhatBothAllow) {
  hal::DeviceInfo info = device(2.0);
  EXPECT_EQ(limits_for(scene(), info).grip_force_N, 0.0) << "a device without a motor there";
  info.grip = {hal::GripKind::kForce, 8.0};
  EXPECT_EQ(limits_for(scene(), info).grip_force_N, scene().grip_force_N);
  info.grip = {hal::GripKind::kForce, 1.0};
  EXPECT_EQ(limits_for(scene(), info).grip_force_N, 1.0);
}

TEST(LimitsFor, AWeakerDeviceLimitsTheScene) {
  const model::Limits limits = limits_for(scene(), device(0.5));
  EXPECT_DOUBLE_EQ(limits.force_N, 2.0);
  EXPECT_DOUBLE_EQ(limits.torque_Nm, 0.1);
  EXPECT_DOUBLE_EQ(limits.workspace_radius_m, 0.05);
  EXPECT_DOUBLE_EQ(limits.workspace_half_length_m, 0.04);
}

TEST(LimitsFor, AStrongerDeviceDoesNotRaiseTheScene) {
  const model::Limits limits = limits_for(scene(), device(2.0));
  EXPECT_DOUBLE_EQ(limits.force_N, 4.0);
  EXPECT_DOUBLE_EQ(limits.torque_Nm, 0.2);
  EXPECT_DOUBLE_EQ(limits.workspace_radius_m, 0.10);
  EXPECT_DOUBLE_EQ(limits.workspace_half_length_m, 0.08);
}

TEST(LimitsFor, TheMotorsContinuousForceLimitsTheSceneWhereReported) {
  model::Limits limits = scene();
  limits.continuous_force_N = 1.5;
  hal::DeviceInfo info = device(1.0);
  EXPECT_DOUBLE_EQ(limits_for(limits, info).continuous_force_N, 1.5) << "not reported";
  info.max_continuous_force_N = 0.88;
  EXPECT_DOUBLE_EQ(limits_for(limits, info).continuous_force_N, 0.88);
  info.max_continuous_force_N = 3.0;
  EXPECT_DOUBLE_EQ(limits_for(limits, info).continuous_force_N, 1.5);
  info.max_continuous_force_N = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(limits_for(limits, info).continuous_force_N, 0.0);
}

TEST(LimitsFor, ALimitThatIsNoNumberIsZero) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const model::Limits by_device = limits_for(scene(), device(nan));
  EXPECT_EQ(by_device.force_N, 0.0);
  EXPECT_EQ(by_device.torque_Nm, 0.0);
  EXPECT_EQ(by_device.workspace_radius_m, 0.0);
  EXPECT_EQ(by_device.workspace_half_length_m, 0.0);
  model::Limits broken = scene();
  broken.force_N = nan;
  EXPECT_EQ(limits_for(broken, device(1.0)).force_N, 0.0);
}

TEST(LimitsFor, SlewLimitIsThatOfTheScene) {
  model::Limits other = scene();
  other.slew_N_per_s = 123.0;
  EXPECT_DOUBLE_EQ(limits_for(other, device(0.5)).slew_N_per_s, 123.0);
}

}  // namespace tact::firmware::gate::limits_for_test
