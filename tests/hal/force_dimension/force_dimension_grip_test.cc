// SPDX-License-Identifier: Apache-2.0
// Grippers and user buttons: how far the jaws are closed, the force on the fingers; torque.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "hal/force_dimension/device_types.h"
#include "hal/force_dimension/force_dimension_device.h"
#include "tests/support/device_loop.h"
#include "tests/support/stub_dhd/stub_client.h"

namespace tact::hal::force_dimension::force_dimension_grip_test {

class ForceDimensionGrip : public tests::DeviceLoop {
 protected:
  void open(int type) {
    stub.set_type(type);
    DeviceLoop::open(tests::stub_scene());
  }

  tests::StubDhd stub;
};

TEST_F(ForceDimensionGrip, AGripperReportsHowFarItIsClosedOnEitherHand) {
  for (const int type : {35, 37, 104, 109}) {
    stub.reset();
    open(type);
    EXPECT_EQ(device->info().grip.kind, GripKind::kForce);
    const double sign = type == 37 ? -1.0 : 1.0;
    ASSERT_TRUE(ready());
    for (const auto& [share, ratio] : {std::pair{1.0, 0.0}, {0.25, 0.75}, {0.0, 1.0}, {1.3, 0.0}}) {
      stub.grip(sign * share * kGripperOpen_rad, 1);
      EXPECT_TRUE(tick_until([&] { return std::abs(sample.tool.grip_ratio - ratio) < 1e-12; }))
          << type << ": " << sample.tool.grip_ratio << " for " << share;
    }
    device.reset();
  }
}

TEST_F(ForceDimensionGrip, TheSceneMaySayHowFarTheGripperOpens) {
  stub.set_type(35);
  auto scene = tests::stub_scene();
  scene.device.of<ForceDimensionSettings>().gripper_open_rad = 0.4;
  DeviceLoop::open(scene);
  stub.grip(0.1, 0);
  ASSERT_TRUE(ready());
  EXPECT_TRUE(tick_until([&] { return std::abs(sample.tool.grip_ratio - 0.75) < 1e-12; }));
}

TEST_F(ForceDimensionGrip, TheUserButtonGripsWhereThereIsNoGripper) {
  open(63);
  EXPECT_EQ(device->info().grip.kind, GripKind::kButton);
  stub.grip(0.0, 2);  // another button, and an angle of 0, which a gripper has when closed
  ASSERT_TRUE(ready());
  EXPECT_EQ(sample.tool.grip_ratio, 0.0);
  stub.grip(0.0, 3);
  EXPECT_TRUE(tick_until([&] { return sample.tool.grip_ratio == 1.0; }));
  stub.grip(0.0, 0);
  EXPECT_TRUE(tick_until([&] { return sample.tool.grip_ratio == 0.0; }));
}

TEST_F(ForceDimensionGrip, AGripperIsOpenedByAPositiveForceOnEitherHand) {
  for (const auto& [type, sign] : {std::pair{104, 1.0}, {105, -1.0}, {35, 1.0}, {37, -1.0}}) {
    stub.reset();
    open(type);
    EXPECT_EQ(device->info().grip.max_force_N, kGripperForce_N);
    ASSERT_TRUE(ready());
    device->set_grip_force(1.25);
    EXPECT_TRUE(tick_until([&] { return stub.last_grip_N() == sign * 1.25; })) << type;
    device->set_grip_force(20.0);
    EXPECT_TRUE(tick_until([&] { return stub.last_grip_N() == sign * kGripperForce_N; })) << type;
    device->set_grip_force(std::nan(""));
    EXPECT_TRUE(tick_until([&] { return stub.last_grip_N() == 0.0; })) << type;
    EXPECT_EQ(fault, Fault::kForceNotFinite);
    device->set_grip_force(1.0);
    ASSERT_TRUE(tick_until([&] { return stub.last_grip_N() != 0.0; }));
    device->stop();
    EXPECT_EQ(stub.last_grip_N(), 0.0) << "zero at the end";
    device.reset();
  }
}

TEST_F(ForceDimensionGrip, TheGapAndItsSpeedAreThoseOfTheFingers) {
  open(35);
  stub.grip(0.4, 0);
  ASSERT_TRUE(ready());
  EXPECT_TRUE(tick_until([&] { return std::abs(sample.grip_gap_m - 0.02) < 1e-12; }));
  EXPECT_TRUE(tick_until([&] { return std::abs(sample.grip_speed_mps) < 1e-6; }));
}

TEST_F(ForceDimensionGrip, NoForceOnFingersThatItDoesNotHave) {
  open(63);
  ASSERT_TRUE(ready());
  device->set_grip_force(1.0);
  tick_until([&] { return sample.tool.position_m.z < 0.0; });
  EXPECT_EQ(stub.last_grip_N(), 0.0);
}

TEST_F(ForceDimensionGrip, AGripperAngleThatIsNoNumberIsReported) {
  open(35);
  stub.grip(std::nan(""), 0);
  EXPECT_TRUE(tick_until([&] { return std::isnan(sample.tool.grip_ratio); }));
}

TEST_F(ForceDimensionGrip, AGripperThatFailsIsAFault) {
  open(35);
  ASSERT_TRUE(ready());
  stub.fail("dhdGetGripperAngleRad", 2);
  EXPECT_TRUE(tick_until([&] { return fault != Fault::kNone; }));
  EXPECT_TRUE(reported("the device does not report its gripper: ")) << device->fault_detail();
}

/// Torque, of each type that has motors for it.
TEST_F(ForceDimensionGrip, TheTorqueArrivesToTheLastDigitAndKeepsItsDirectionAtTheLimit) {
  for (const int type : {61, 62, 64, 104, 105, 106, 107, 108, 109}) {
    stub.reset();
    open(type);
    const DeviceInfo info = device->info();
    EXPECT_EQ(info.max_torque_Nm, 0.2) << type;
    EXPECT_EQ(info.caution.find("still knows this type") != std::string::npos, type < 70) << type;
    ASSERT_TRUE(ready());
    double force[6] = {};
    const auto arrives = [&](const Vec3& wanted_Nm) {
      return tick_until(
          [&] {
            stub.last_force(force);
            return force[3] == wanted_Nm.x && force[4] == wanted_Nm.y && force[5] == wanted_Nm.z;
          },
          {.force_N = {0.5, 0.0, 0.0}, .torque_Nm = wanted_Nm});
    };
    EXPECT_TRUE(arrives({0.0279, -0.0123456789012345, 0.1})) << type;
    EXPECT_TRUE(tick_until(
        [&] {
          stub.last_force(force);
          return std::abs(std::hypot(force[3], force[4], force[5]) - 0.2) < 1e-15;
        },
        {.force_N = {}, .torque_Nm = {0.3, 0.0, 0.4}}))
        << type;
    EXPECT_NEAR(force[3], 0.12, 1e-15);
    EXPECT_NEAR(force[5], 0.16, 1e-15);
    device.reset();
  }
}

}  // namespace tact::hal::force_dimension::force_dimension_grip_test
