// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/force_dimension_device.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/device_loop.h"
#include "tests/support/stub_dhd/stub_client.h"

namespace tact::hal::force_dimension::force_dimension_device_test {

class ForceDimension : public tests::DeviceLoop {
 protected:
  void open(int type = 63) {
    stub.set_type(type);
    DeviceLoop::open(tests::stub_scene());
  }
  /// What arrives at the device's motors: 0 while its forces are off.
  Vec3 rendered_N() {
    double force[6];
    return stub.last_force(force) == 0 ? Vec3{} : Vec3{force[0], force[1], force[2]};
  }
  struct Calls {
    long reads = 0, forces = 0, switches = 0;
  };
  /// Of the same cycle of the worker: it has read and switched nothing meanwhile.
  Calls calls() const {
    const auto reads = [&] { return stub.calls("dhdGetPositionAndOrientationFrame"); };
    Calls c;
    do {
      c = {.reads = reads(),
           .forces = stub.calls("dhdSetForceAndTorqueAndGripperForce"),
           .switches = stub.calls("dhdEnableForce")};
    } while (reads() != c.reads || stub.calls("dhdEnableForce") != c.switches);
    return c;
  }

  tests::StubDhd stub;
};

TEST_F(ForceDimension, MakesNoForceBeforeTheLoopPermitsIt) {
  open();
  permitted = false;
  for (int i = 0; i < 50; ++i) tick({.force_N = {0, 0, 5}, .torque_Nm = {}});
  EXPECT_EQ(stub.strongest_N(), 0.0);
  double force[6];
  EXPECT_EQ(stub.last_force(force), 0) << "forces are off";
  EXPECT_TRUE(sample.fresh || ready()) << "the pose is reported without power";
}

TEST_F(ForceDimension, IsFreshOnlyAfterTheForcesAreOnWithZeroShown) {
  open();
  for (int i = 0; i < 500; ++i) {
    tick();
    double force[6];
    const bool on = stub.last_force(force) != 0;
    if (!sample.fresh) continue;
    EXPECT_TRUE(on);
    return;
  }
  FAIL() << "never fresh";
}

TEST_F(ForceDimension, TheVendorsAxesAreThoseOfW) {
  open();
  stub.hold(0.011, -0.022, 0.033);
  ASSERT_TRUE(ready());
  tick_until([&] { return sample.fresh && sample.tool.position_m == Vec3{0.011, -0.022, 0.033}; });
  EXPECT_EQ(sample.tool.position_m, (Vec3{0.011, -0.022, 0.033}));
  EXPECT_TRUE(tick_until([&] { return rendered_N() == Vec3{1, 2, 3}; },
                         {.force_N = {1, 2, 3}, .torque_Nm = {}}));
}

TEST_F(ForceDimension, TooMuchForceIsScaledWithItsDirection) {
  open();
  ASSERT_TRUE(ready());
  EXPECT_TRUE(tick_until([&] { return norm(rendered_N()) > 19.0; },
                         {.force_N = {30, 0, 40}, .torque_Nm = {}}));
  EXPECT_NEAR(rendered_N().x, 12.0, 1e-12);
  EXPECT_NEAR(rendered_N().z, 16.0, 1e-12);
}

TEST_F(ForceDimension, NoForceIsMadeOfNaNAndNoTorqueWithoutMotors) {
  open();
  ASSERT_TRUE(ready());
  const double nan = std::nan("");
  for (int i = 0; i < 20; ++i) {
    tick({.force_N = {nan, 1, 1}, .torque_Nm = {1, 1, 1}});
    double force[6];
    stub.last_force(force);
    for (const double f : force) ASSERT_EQ(f, 0.0);
  }
}

TEST_F(ForceDimension, OneReadAndOneForcePerCycleAndNoneFromTheLoop) {
  open();
  ASSERT_TRUE(ready());
  const Calls before = calls();
  for (int i = 0; i < 200; ++i) tick();
  const Calls after = calls();
  const long reads = after.reads - before.reads;
  // A switch of the forces, after a silence of a busy PC, shows the device zero first.
  const long forces = after.forces - before.forces - (after.switches - before.switches);
  EXPECT_LE(std::abs(forces - reads), 1);
  EXPECT_GT(reads, 200);
  static_cast<void>(
      device->read(sample, now_ns()));  // without a sleep in between: nothing is asked here
  EXPECT_LE(calls().switches, 2 + 2 * silences)
      << "once off while opening, once on; the same for each silence that a busy PC made";
}

TEST_F(ForceDimension, SamplesNeverRepeat) {
  open();
  ASSERT_TRUE(ready());
  std::uint64_t before = sample.sequence;
  for (int i = 0; i < 200; ++i) {
    tick();
    if (!sample.fresh) continue;
    ASSERT_GT(sample.sequence, before);
    before = sample.sequence;
  }
}

TEST_F(ForceDimension, APoseThatTheLibraryCallsOldIsNoSampleAndNoFault) {
  open();
  ASSERT_TRUE(ready());
  stub.set_pose_answer(1);  // the time guard: "nothing new"
  sleep_ms(20);
  tick();  // takes what came before
  for (int i = 0; i < 30; ++i) {
    tick();
    ASSERT_FALSE(sample.fresh);
    ASSERT_EQ(fault, Fault::kNone);
  }
}

TEST_F(ForceDimension, ASampleOlderThan5msIsNotFresh) {
  open();
  ASSERT_TRUE(ready());
  sleep_ms(2);
  EXPECT_EQ(device->read(sample, now_ns() + 6 * kMs), Fault::kNone);
  EXPECT_FALSE(sample.fresh);
}

TEST_F(ForceDimension, HangingLibraryDoesNotBlockTheLoop) {
  open();
  expect_a_hang_to_stop_nothing(stub);
}

TEST_F(ForceDimension, DeadLoopGetsZeroForceAndThenForcesOff) {
  open();
  ASSERT_TRUE(ready());
  ASSERT_TRUE(
      tick_until([&] { return rendered_N().z == 5.0; }, {.force_N = {0, 0, 5}, .torque_Nm = {}}));
  double force[6];
  EXPECT_TRUE(comes([&] { return stub.last_force(force) >= 0 && force[2] == 0.0; }));
  EXPECT_EQ(stub.last_force(force), 1) << "zero, but its weight is still balanced";
  EXPECT_TRUE(comes([&] { return stub.last_force(force) == 0; })) << "then the forces go off";
}

TEST_F(ForceDimension, WithdrawnPowerSwitchesTheForcesOffAndComesBackThroughZero) {
  open();
  ASSERT_TRUE(ready());
  double force[6];
  ASSERT_TRUE(tick_until([&] { return stub.last_force(force) == 1 && force[2] == 5.0; },
                         {.force_N = {0, 0, 5}, .torque_Nm = {}}));
  permitted = false;
  EXPECT_TRUE(tick_until([&] { return stub.last_force(force) == 0; },
                         {.force_N = {0, 0, 5}, .torque_Nm = {}}));
  for (int i = 0; i < 200; ++i) tick();
  EXPECT_EQ(fault, Fault::kNone) << "forces that we switched off are no news";
  permitted = true;
  EXPECT_TRUE(tick_until([&] { return stub.last_force(force) == 1 && sample.fresh; }));
  EXPECT_EQ(stub.switched_with_force(), 0) << "zero first";
}

TEST_F(ForceDimension, VelocityFollowsTheHandle) {
  open();
  expect_velocity_of_the_led_handle();
}

TEST_F(ForceDimension, AWristThatTurnsHasARate) {
  stub.spin(2.0);
  open(104);
  ASSERT_TRUE(ready());
  EXPECT_TRUE(tick_until([&] {
    return std::abs(sample.tool.angular_velocity_radps.z - 2.0) < 0.1;
  })) << sample.tool.angular_velocity_radps.z;
  EXPECT_NEAR(sample.tool.angular_velocity_radps.x, 0.0, 1e-9);
  const auto& q = sample.tool.orientation;
  EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1.0, 1e-12);
}

TEST_F(ForceDimension, InfoIsThatOfItsType) {
  setenv("TACT_STUB_DHD_SERIAL", "1234", 1);
  open(104);
  const DeviceInfo info = device->info();
  EXPECT_EQ(info.name, "Force Dimension sigma.7 right no. 1234");
  EXPECT_EQ(info.max_force_N, 12.0);
  EXPECT_EQ(info.max_torque_Nm, 0.2);
  ASSERT_TRUE(info.at_tool);
  EXPECT_EQ(info.at_tool->damping_Ns_per_m, 1.0);
  EXPECT_EQ(info.damping_key, "device.force_dimension.damping_Ns_per_m");
}

TEST_F(ForceDimension, StopSwitchesOffAndClosesTwiceWithoutHarm) {
  open();
  ASSERT_TRUE(ready());
  tick({.force_N = {0, 0, 5}, .torque_Nm = {}});
  device->stop();
  double force[6];
  EXPECT_EQ(stub.last_force(force), 0);
  EXPECT_EQ(force[2], 0.0);
  EXPECT_FALSE(stub.is_open());
  device->stop();
  EXPECT_EQ(stub.calls("dhdClose"), 1);
}

TEST_F(ForceDimension, TheLoopLeavesTheHeapAlone) {
  open();
  expect_the_heap_left_alone();
}

}  // namespace tact::hal::force_dimension::force_dimension_device_test
