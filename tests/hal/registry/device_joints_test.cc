// SPDX-License-Identifier: Apache-2.0
// What a run's head says of a device's joints leads from W to the frame of its kinematics.
#include <gtest/gtest.h>

#include "hal/can/can_settings.h"
#include "hal/delta/delta_frame.h"
#include "hal/falcon/falcon_kinematics.h"
#include "hal/mounting.h"
#include "hal/registry/open_device.h"
#include "hal/sim/sim_delta_model.h"
#include "tests/support/example_delta.h"

namespace tact::hal::registry::device_joints_test {

using model::DeviceJoints;

model::DeviceSettings mounted(const char* kind) {
  model::DeviceSettings settings = tests::example_delta();
  settings.kind = kind;
  settings.base_orientation_deg = {10.0, -20.0, 30.0};
  settings.base_position_m = {0.02, -0.03, 0.04};
  settings.motion_scale = 2.5;
  return settings;
}

/// M p_W + o
Vec3 in_device(const DeviceJoints& joints, const Vec3& p_W) {
  const auto row = [&](std::size_t i) {
    const auto& m = joints.row[i];
    return m[0] * p_W.x + m[1] * p_W.y + m[2] * p_W.z + joints.origin_m[i];
  };
  return {row(0), row(1), row(2)};
}

TEST(DeviceJoints, LeadFromTheToolToTheFrameOfTheKinematics) {
  const Vec3 p_D{0.03, -0.02, 0.13};
  const double middle_m = tests::example_delta().of<can::DeltaSettings>().middle_m;
  ASSERT_NE(middle_m, 0.0);
  const auto falcon_W = [](const Vec3& p) { return Vec3{p.z - falcon::kFalconMiddle_m, p.x, p.y}; };
  const std::pair<const char*, Vec3> in_base[] = {{"sim-delta", sim::point_W(p_D)},
                                                  {"sim-ideal", sim::point_W(p_D)},
                                                  {"can-odrive", delta::point_W(p_D, middle_m)},
                                                  {"can-cia402", delta::point_W(p_D, middle_m)},
                                                  {"can-moteus", delta::point_W(p_D, middle_m)},
                                                  {"falcon", falcon_W(p_D)}};
  for (const auto& [kind, p_B] : in_base) {
    const model::DeviceSettings settings = mounted(kind);
    const Vec3 found = in_device(joints_of(settings), mounting_of(settings).point_W(p_B));
    EXPECT_LT(norm(found - p_D), 1e-15) << kind;
  }
}

TEST(DeviceJoints, OfADeltaOnCanAreItsMeasuredLengths) {
  model::DeviceSettings settings = mounted("can-odrive");
  auto& delta = settings.of<can::DeltaSettings>();
  delta.base_radius_m = 0.11;
  delta.platform_radius_m = 0.04;
  delta.upper_arm_m = 0.21;
  delta.forearm_m = 0.31;
  delta.azimuth_rad = {0.1, 2.2, 4.3};
  const DeviceJoints joints = joints_of(settings);
  EXPECT_EQ(joints.linkage, "delta");
  EXPECT_EQ(joints.base_radius_m, 0.11);
  EXPECT_EQ(joints.platform_radius_m, 0.04);
  EXPECT_EQ(joints.upper_arm_m, 0.21);
  EXPECT_EQ(joints.forearm_m, 0.31);
  EXPECT_EQ(joints.azimuth_rad, (std::array{0.1, 2.2, 4.3}));
  EXPECT_EQ(joints_of(mounted("falcon")).linkage, "falcon");
}

TEST(DeviceJoints, AreUnknownBehindAVendorsLibrary) {
  for (const char* kind : {"force-dimension", "phantom", "none"})
    EXPECT_EQ(joints_of(mounted(kind)).linkage, "") << kind;
}

}  // namespace tact::hal::registry::device_joints_test
