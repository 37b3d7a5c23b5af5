// SPDX-License-Identifier: Apache-2.0
#include "hal/phantom/phantom_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hal/phantom/hd_library.h"
#include "tests/support/device_loop.h"
#include "tests/support/stub_hd/hd_client.h"

namespace tact::hal::phantom::phantom_device_test {

class Phantom : public tests::DeviceLoop {
 protected:
  void TearDown() override {
    device.reset();
    EXPECT_EQ(stub.unsafe_calls(), 0) << "the output is switched at zero alone";
  }
  void open() { DeviceLoop::open(tests::phantom_scene()); }
  /// What arrives at the motors, in the device's frame: 0 while the force output is off.
  Vec3 rendered_N() {
    double force[3];
    return stub.last_force(force) == 0 ? Vec3{} : Vec3{force[0], force[1], force[2]};
  }
  bool output_is_on() {
    double force[3];
    return stub.last_force(force) != 0;
  }

  tests::StubHd stub;
};

TEST_F(Phantom, MakesNoForceBeforeTheLoopPermitsIt) {
  open();
  permitted = false;
  for (int i = 0; i < 50; ++i) tick({.force_N = {0, 0, 2}, .torque_Nm = {}});
  EXPECT_EQ(stub.strongest_N(), 0.0);
  EXPECT_FALSE(output_is_on());
  EXPECT_TRUE(sample.fresh || ready()) << "the pose is reported without power";
}

TEST_F(Phantom, IsFreshOnlyAfterTheForceOutputIsOnWithZeroShown) {
  open();
  for (int i = 0; i < 500; ++i) {
    tick({.force_N = {0, 0, 2}, .torque_Nm = {}});
    if (!sample.fresh) continue;
    EXPECT_TRUE(output_is_on());
    return;
  }
  FAIL() << "never fresh";
}

TEST_F(Phantom, RightUpAndTowardsTheOperatorAreYZAndXOfW) {
  open();
  // The middle of the box where the vendor promises forces is 0, 10, 5 mm.
  stub.hold(11.0, 32.0, -28.0);
  const auto there = [&] {
    return sample.fresh && norm(sample.tool.position_m - Vec3{-0.033, 0.011, 0.022}) < 1e-12;
  };
  EXPECT_TRUE(tick_until(there));
  // 1 N towards the operator, 2 to the right, 1.5 up.
  EXPECT_TRUE(tick_until([&] { return rendered_N() == Vec3{2.0, 1.5, 1.0}; },
                         {.force_N = {1.0, 2.0, 1.5}, .torque_Nm = {}}));
}

TEST_F(Phantom, AStylusThatTurnsAboutTheVerticalTurnsAboutZOfW) {
  stub.spin(2.0);
  open();
  ASSERT_TRUE(ready());
  EXPECT_TRUE(tick_until([&] {
    return std::abs(sample.tool.angular_velocity_radps.z - 2.0) < 0.2;
  })) << sample.tool.angular_velocity_radps.z;
  EXPECT_NEAR(sample.tool.angular_velocity_radps.x, 0.0, 1e-9);
  EXPECT_NEAR(sample.tool.angular_velocity_radps.y, 0.0, 1e-9);
}

TEST_F(Phantom, AnUprightStylusIsAnUprightTool) {
  open();
  ASSERT_TRUE(ready());
  EXPECT_NEAR(std::abs(sample.tool.orientation.w), 1.0, 1e-12);
}

TEST_F(Phantom, AStylusThatLiesTowardsTheOperatorHasItsHandleAlongXOfW) {
  stub.lean(std::numbers::pi / 2);
  open();
  ASSERT_TRUE(ready());
  const Vec3 handle = rotate(sample.tool.orientation, {0, 0, 1});
  EXPECT_NEAR(handle.x, 1.0, 1e-12);
  const Vec3 right = rotate(sample.tool.orientation, {0, 1, 0});
  EXPECT_NEAR(right.y, 1.0, 1e-12) << "it was leant about the device's x";
}

TEST_F(Phantom, ADeviceWithThreeAxesHasNoOrientation) {
  stub.set_number(kHdInputDof, 3);
  stub.spin(2.0);
  open();
  ASSERT_TRUE(ready());
  EXPECT_EQ(sample.tool.orientation, model::Quat{});
}

TEST_F(Phantom, TooMuchForceIsScaledWithItsDirection) {
  open();
  ASSERT_TRUE(ready());
  EXPECT_TRUE(tick_until([&] { return norm(rendered_N()) > 3.2; },
                         {.force_N = {6, 0, 8}, .torque_Nm = {}}));
  EXPECT_NEAR(rendered_N().z, 3.3 * 0.6, 1e-12);
  EXPECT_NEAR(rendered_N().y, 3.3 * 0.8, 1e-12);
}

TEST_F(Phantom, NoForceIsMadeOfNaNAndItIsAFaultOfThatTick) {
  open();
  ASSERT_TRUE(ready());
  for (int i = 0; i < 20; ++i) {
    tick({.force_N = {std::nan(""), 1, 1}, .torque_Nm = {1, 1, 1}});
    ASSERT_EQ(rendered_N(), Vec3{});
    ASSERT_EQ(fault, Fault::kForceNotFinite);
  }
  tick();
  EXPECT_EQ(fault, Fault::kNone);
}

TEST_F(Phantom, IsReadyOnlyWhileAForceWouldReachTheHand) {
  open();
  EXPECT_FALSE(device->ready()) << "the force output is off";
  ASSERT_TRUE(ready());
  EXPECT_TRUE(device->ready());
  permitted = false;
  tick();
  EXPECT_FALSE(device->ready());
  for (int i = 0; i < 50; ++i) tick();
  permitted = true;
  tick();
  EXPECT_FALSE(device->ready()) << "the force output is still off";
  EXPECT_TRUE(tick_until([&] { return device->ready(); }));
}

TEST_F(Phantom, ACommandThatGrewOldWhileTheLibraryWaitedIsWorthZero) {
  open();
  ASSERT_TRUE(ready());
  ASSERT_TRUE(
      tick_until([&] { return rendered_N().y == 2.0; }, {.force_N = {0, 0, 2}, .torque_Nm = {}}));
  stub.set_delay_us(40'000);  // of the frame that begins within a millisecond
  sleep_ms(55);
  EXPECT_EQ(rendered_N(), Vec3{});
  stub.set_delay_us(0);
}

TEST_F(Phantom, OneFrameForEachCycleOfTheLibraryAndNoneFromTheLoop) {
  open();
  ASSERT_TRUE(ready());
  const long begun = stub.calls("hdBeginFrame");
  for (int i = 0; i < 200; ++i) tick({.force_N = {0, 0, 1}, .torque_Nm = {}});
  EXPECT_EQ(fault, Fault::kNone) << device->fault_detail() << ": the stub refuses a second frame";
  EXPECT_GT(stub.calls("hdBeginFrame") - begun, 100);
  EXPECT_LE(stub.calls("hdEnable"), 2 + silences) << "the clamping, and the output once";
}

TEST_F(Phantom, SamplesNeverRepeatAndOldOnesAreNotFresh) {
  open();
  ASSERT_TRUE(ready());
  std::uint64_t before = sample.sequence;
  for (int i = 0; i < 200; ++i) {
    tick();
    if (!sample.fresh) continue;
    ASSERT_GT(sample.sequence, before);
    before = sample.sequence;
  }
  sleep_ms(2);
  EXPECT_EQ(device->read(sample, now_ns() + 6 * kMs), Fault::kNone);
  EXPECT_FALSE(sample.fresh);
}

TEST_F(Phantom, HangingLibraryDoesNotBlockTheLoop) {
  open();
  expect_a_hang_to_stop_nothing(stub);
}

TEST_F(Phantom, DeadLoopGetsZeroForceAndThenForcesOff) {
  open();
  ASSERT_TRUE(ready());
  ASSERT_TRUE(
      tick_until([&] { return rendered_N().y == 2.0; }, {.force_N = {0, 0, 2}, .torque_Nm = {}}));
  double force[3];
  EXPECT_TRUE(comes([&] { return stub.last_force(force) >= 0 && force[1] == 0.0; }));
  EXPECT_EQ(stub.last_force(force), 1) << "zero first";
  EXPECT_TRUE(comes([&] { return !output_is_on(); })) << "then the force output goes off";
}

TEST_F(Phantom, WithdrawnPowerTurnsForceOutputOffAndReturnsThroughZero) {
  open();
  ASSERT_TRUE(ready());
  ASSERT_TRUE(
      tick_until([&] { return rendered_N().y == 2.0; }, {.force_N = {0, 0, 2}, .torque_Nm = {}}));
  permitted = false;
  EXPECT_TRUE(tick_until([&] { return !output_is_on(); }, {.force_N = {0, 0, 2}, .torque_Nm = {}}));
  for (int i = 0; i < 200; ++i) tick();
  EXPECT_EQ(fault, Fault::kNone) << "an output that we switched off is no news";
  permitted = true;
  EXPECT_TRUE(tick_until([&] { return output_is_on() && sample.fresh; }));
}

TEST_F(Phantom, VelocityFollowsTheHandle) {
  open();
  expect_velocity_of_the_led_handle();
}

TEST_F(Phantom, ItsFirstButtonClosesTheJaws) {
  open();
  EXPECT_EQ(device->info().grip.kind, GripKind::kButton);
  stub.set_number(kHdCurrentButtons, 2);  // the second one
  ASSERT_TRUE(ready());
  EXPECT_EQ(sample.tool.grip_ratio, 0.0);
  stub.set_number(kHdCurrentButtons, 3);
  EXPECT_TRUE(tick_until([&] { return sample.tool.grip_ratio == 1.0; }));
  stub.set_number(kHdCurrentButtons, 0);
  EXPECT_TRUE(tick_until([&] { return sample.tool.grip_ratio == 0.0; }));
}

TEST_F(Phantom, InfoIsWhatTheLibraryReports) {
  open();
  const DeviceInfo info = device->info();
  EXPECT_EQ(info.name, "Touch no. " + std::to_string(getpid()));
  EXPECT_EQ(info.max_force_N, 3.3);
  EXPECT_EQ(info.max_torque_Nm, 0.0);
  EXPECT_EQ(info.max_continuous_force_N, 0.88);
  EXPECT_NEAR(info.workspace_radius_m, 0.060, 1e-12) << "of 160 x 120 mm";
  EXPECT_NEAR(info.workspace_half_length_m, 0.035, 1e-12);
  ASSERT_TRUE(info.at_tool);
  EXPECT_EQ(info.at_tool->damping_Ns_per_m, 1.0);
  EXPECT_EQ(info.damping_key, "device.phantom.damping_Ns_per_m");
  for (const char* part : {"nothing zeroes this device", "or the library hangs", "for long: 0.88 N",
                           "advises: 500 N/m", "assumed, not measured"})
    EXPECT_NE(info.caution.find(part), std::string::npos) << info.caution;
  EXPECT_FALSE(device->shutdown_frames());
  EXPECT_TRUE(device->loop_calls().empty());
}

TEST_F(Phantom, ADampingOfTheSceneIsNotCalledAssumed) {
  auto scene = tests::phantom_scene();
  scene.device.of<PhantomSettings>().damping_Ns_per_m = 0.4;
  DeviceLoop::open(scene);
  EXPECT_EQ(device->info().caution.find("assumed"), std::string::npos) << device->info().caution;
}

TEST_F(Phantom, TheContinuousForceOfItsMotorsMayBeUnknown) {
  for (const double reported_N : {0.0, -1.0, std::nan("")}) {
    stub.set_number(kHdContinuousForce, reported_N);
    open();
    EXPECT_EQ(device->info().max_continuous_force_N, 0.0);
    EXPECT_NE(device->info().caution.find("for long: not known"), std::string::npos);
  }
}

TEST_F(Phantom, StopSwitchesOffAndClosesTwiceWithoutHarm) {
  open();
  ASSERT_TRUE(ready());
  ASSERT_TRUE(
      tick_until([&] { return rendered_N().y == 2.0; }, {.force_N = {0, 0, 2}, .torque_Nm = {}}));
  device->stop();
  double force[3];
  EXPECT_EQ(stub.last_force(force), 0);
  EXPECT_EQ(force[1], 0.0);
  EXPECT_FALSE(stub.is_open());
  EXPECT_EQ(device->why_not_off(), "");
  EXPECT_EQ(device->fault_detail(), "");
  device->stop();
  EXPECT_EQ(stub.calls("hdDisableDevice"), 1);
}

TEST_F(Phantom, TheLoopLeavesTheHeapAlone) {
  open();
  expect_the_heap_left_alone();
}

}  // namespace tact::hal::phantom::phantom_device_test
