// SPDX-License-Identifier: Apache-2.0
// The simulated delta as mounted: its weight, its hand and its force follow the mounting.
#include <gtest/gtest.h>

#include <memory>

#include "hal/mounted_device.h"
#include "hal/mounting.h"
#include "hal/sim/sim_delta.h"
#include "tests/hal/sim/sim_bench.h"
#include "tests/support/mountings.h"

namespace tact::hal::sim::sim_mounting_test {

using namespace tact::tests;
using hal::MountedDevice;
using hal::Mounting;
using hal::mounting_of;

TEST(SimMounting, StaysWhereItIsLetGoInSixMountings) {
  for (const auto& one : kMountings) {
    const Mounting mounting = mounting_of(settings_of(one));
    SimDeviceSettings smooth = settings();
    smooth.joint_friction_Nm = 0.0;  // else friction would hold it
    MountedDevice device(
        std::make_unique<SimDelta>(smooth, hand_at({0.02, 0.01, -0.02}, 0.0), mounting), mounting);
    Sample sample;
    for (std::int64_t now_ns = 0; now_ns < 500 * kTick_ns; now_ns += kTick_ns) {
      device.between_ticks(kTick_s);
      ASSERT_EQ(device.read(sample, now_ns), Fault::kNone);
      ASSERT_EQ(device.write({}), Fault::kNone);
    }
    EXPECT_LT(norm(sample.tool.position_m - Vec3{0.02, 0.01, -0.02}), 1e-3) << one.words;
  }
}

TEST(SimMounting, ItsHandGoesWhereTheSceneSaysInEveryMounting) {
  for (const auto& one : kMountings) {
    model::DeviceSettings mounted = settings_of(one);
    mounted.motion_scale = 1.5;
    mounted.base_position_m = {0.01, 0.0, 0.02};
    const Mounting mounting = mounting_of(mounted);
    MountedDevice device(
        std::make_unique<SimDelta>(settings(), hand_at({0.03, -0.02, 0.04}, 600.0), mounting),
        mounting);
    Sample sample;
    for (std::int64_t now_ns = 0; now_ns < 500 * kTick_ns; now_ns += kTick_ns) {
      device.between_ticks(kTick_s);
      ASSERT_EQ(device.read(sample, now_ns), Fault::kNone);
      ASSERT_EQ(device.write({.force_N = {0.0, 0.0, 0.5}, .torque_Nm = {}}), Fault::kNone);
    }
    // 0.5 N up is 0.75 N at the handle: 600 N/m give 1.25 mm there, 1.875 mm at the tool.
    EXPECT_NEAR(sample.tool.position_m.z, 0.04 + 0.001875, 2e-4) << one.words;
    EXPECT_NEAR(sample.tool.position_m.x, 0.03, 2e-4) << one.words;
    EXPECT_NEAR(sample.tool.position_m.y, -0.02, 2e-4) << one.words;
  }
}

}  // namespace tact::hal::sim::sim_mounting_test
