// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/hal/falcon/falcon_bench.h"
#include "tests/support/no_alloc.h"

namespace tact::tests::falcon_device_test {

constexpr falcon::FalconWords kNoWords{};

bool names(const FalconBench& bench, const char* what) {
  return bench.device.fault_detail().find(what) != std::string::npos;
}

TEST(FalconDevice, AsksToBeHomedWithoutForceAndShowsNothing) {
  FalconBench bench;
  bench.report = {.counts = {100, 200, 300}, .homed = 0x5};
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(bench.tick({3.0, 0.0, 0.0}));
    EXPECT_EQ(bench.words(), kNoWords);
    EXPECT_TRUE(bench.pipe->command.homing);
    EXPECT_EQ(bench.pipe->command.lights, falcon::kFalconRed);
    EXPECT_EQ(bench.fault, Fault::kNone);
  }
  EXPECT_TRUE(names(bench, "not homed (axis 2 (right))")) << bench.device.fault_detail();
  EXPECT_TRUE(names(bench, "pull the grip all the way out"));
}

TEST(FalconDevice, IsFreshWhenAllAxesAreHomedAndForgetsWhatWasBefore) {
  FalconBench bench;
  bench.report = {.counts = {-900, 400, 0}, .homed = 0x6};
  bench.run(10);
  bench.report = homed_at({0.01, -0.02, 0.015});
  ASSERT_TRUE(bench.tick());
  EXPECT_LT(norm(bench.sample.tool.position_m - Vec3{0.01, -0.02, 0.015}), 0.06e-3);
  EXPECT_EQ(bench.sample.tool.velocity_mps, Vec3{});  // the counts jumped, nothing moved
  ASSERT_TRUE(bench.tick());
  EXPECT_EQ(bench.sample.tool.velocity_mps, Vec3{});
  EXPECT_EQ(bench.device.fault_detail(), "");
  EXPECT_EQ(bench.pipe->command.lights, falcon::kFalconGreen);
  bench.device.permit(false);
  bench.tick();
  EXPECT_EQ(bench.pipe->command.lights, falcon::kFalconBlue);
}

TEST(FalconDevice, KeepsTheHomingRequestOnlyIfConfigured) {
  for (const bool keep : {true, false}) {
    hal::falcon::FalconSettings settings = falcon_settings();
    settings.keep_homing = keep;
    FalconBench bench(settings);
    bench.tick();
    EXPECT_TRUE(bench.pipe->command.homing);
    bench.home();
    EXPECT_EQ(bench.pipe->command.homing, keep);
  }
}

TEST(FalconDevice, TowardsTheUserIsXRightIsYUpIsZ) {
  // Frame of the device: x right, y up, z towards the user. The first axis is the top one.
  const falcon::FalconKinematics kinematics;
  FalconBench bench;
  for (const Vec3& p_W : {Vec3{0.02, 0.0, 0.0}, Vec3{0.0, 0.02, 0.0}, Vec3{0.0, 0.0, 0.02}}) {
    bench.home(p_W);
    bench.run(40);
    EXPECT_LT(norm(bench.sample.tool.position_m - p_W), 0.06e-3);
  }
  const delta::Joints out = kinematics.inverse({0.0, 0.0, 0.140}).thigh_rad;
  const delta::Joints in = kinematics.inverse({0.0, 0.0, 0.100}).thigh_rad;
  EXPECT_GT(out[0], in[0]);  // towards the user the thighs rise
}

TEST(FalconDevice, VelocityIsThatOfTheGrip) {
  FalconBench bench;
  bench.home();
  for (int i = 0; i < 200; ++i) {
    bench.report = homed_at({0.0, 0.0001 * i, 0.0});
    bench.tick();
  }
  EXPECT_NEAR(bench.sample.tool.velocity_mps.y, 0.1, 0.01);
  EXPECT_NEAR(bench.sample.tool.velocity_mps.x, 0.0, 0.01);
}

TEST(FalconDevice, MakesTheForceItIsAskedForThroughTheGainOfEachAxis) {
  FalconBench bench;
  for (const Vec3& p_W : {Vec3{}, Vec3{0.03, 0.02, -0.01}, Vec3{-0.03, -0.02, 0.02}}) {
    bench.home(p_W);
    bench.run(60);
    for (const Vec3& force_N : {Vec3{2.0, 0.0, 0.0}, Vec3{0.0, -2.0, 0.0}, Vec3{0.5, 0.5, 2.0}}) {
      bench.tick(force_N);
      const Vec3 rendered_N = force_of(bench.words(), falcon_settings(), p_W);
      EXPECT_LT(norm(rendered_N - force_N), 0.01)
          << rendered_N.x << " " << rendered_N.y << " " << rendered_N.z;
    }
  }
}

TEST(FalconDevice, APositiveWordLowersTheThighs) {
  FalconBench bench;
  bench.home();
  bench.tick({2.0, 0.0, 0.0});  // towards the user: thighs up
  for (const int word : bench.words()) EXPECT_LT(word, -100);
  bench.tick({-2.0, 0.0, 0.0});
  for (const int word : bench.words()) EXPECT_GT(word, 100);
}

TEST(FalconDevice, TooMuchForceKeepsItsDirection) {
  FalconBench bench;
  bench.home({0.02, 0.0, 0.0});
  bench.run(60);
  const Vec3 wanted_N{8.0, 20.0, 30.0};
  bench.tick(wanted_N);
  int largest = 0;
  for (const int word : bench.words()) largest = std::max(largest, std::abs(word));
  EXPECT_EQ(largest, falcon::kFalconMotorMax);
  const Vec3 rendered_N = force_of(bench.words(), falcon_settings(), {0.02, 0.0, 0.0});
  EXPECT_GT(dot(normalized(rendered_N), normalized(wanted_N)), 0.99999);
}

TEST(FalconDevice, ItsForceLimitCanBeMadeEverywhere) {
  FalconBench bench;
  const double limit_N = bench.device.info().max_force_N;
  EXPECT_GT(limit_N, 3.0);
  EXPECT_LE(limit_N, 8.0);
  for (const double angle_rad : {0.3, 1.7, 2.9, 4.4, 5.8}) {
    const Vec3 p_W{-0.04, 0.04 * std::cos(angle_rad), 0.04 * std::sin(angle_rad)};
    bench.home(p_W);
    bench.run(100);
    ASSERT_TRUE(bench.sample.fresh);
    for (const Vec3& along :
         {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0.6, -0.8}, Vec3{-0.6, 0, 0.8}}) {
      bench.tick(limit_N * along);
      EXPECT_LT(norm(force_of(bench.words(), falcon_settings(), p_W) - limit_N * along), 0.03);
    }
  }
}

TEST(FalconDevice, TheDeadBandIsAddedAlongTheTorqueAndNotAtRest) {
  hal::falcon::FalconSettings settings = falcon_settings();
  FalconBench plain(settings);
  settings.dead_band_words = {150.0, 200.0, 250.0};
  FalconBench banded(settings);
  plain.home();
  banded.home();
  plain.tick({2.0, 0.0, 0.0});
  banded.tick({2.0, 0.0, 0.0});
  EXPECT_EQ(banded.words()[0] - plain.words()[0], -150);
  EXPECT_EQ(banded.words()[1] - plain.words()[1], -200);
  EXPECT_EQ(banded.words()[2] - plain.words()[2], -250);
  banded.tick();
  EXPECT_EQ(banded.words(), kNoWords);
  int before = 0;
  for (double force_N = 0.0; force_N < 0.2; force_N += 0.0005) {  // no leap on the way
    banded.tick({force_N, 0.0, 0.0});
    EXPECT_LE(std::abs(banded.words()[2] - before), 5);
    before = banded.words()[2];
  }
}

TEST(FalconDevice, HoldsItsOwnWeightUp) {
  hal::falcon::FalconSettings settings = falcon_settings();
  settings.moving_mass_kg = 0.1;
  FalconBench bench(settings);
  bench.home({0.01, 0.0, 0.0});
  bench.run(60);
  const Vec3 rendered_N = force_of(bench.words(), settings, {0.01, 0.0, 0.0});
  EXPECT_LT(norm(rendered_N - Vec3{0.0, 0.0, 0.981}), 0.01);
}

TEST(FalconDevice, ItsWeightIsHeldFirstAndTheForceKeepsItsDirectionBesideIt) {
  hal::falcon::FalconSettings settings = falcon_settings();
  settings.moving_mass_kg = 0.2;
  FalconBench bench(settings);
  bench.home();
  bench.run(60);
  const Vec3 wanted_N{10.0, 5.0, 20.0};
  bench.tick(wanted_N);
  const Vec3 pushed_N = force_of(bench.words(), settings, {}) - Vec3{0.0, 0.0, 0.2 * 9.81};
  EXPECT_GT(norm(pushed_N), 3.0);
  EXPECT_GT(dot(normalized(pushed_N), normalized(wanted_N)), 0.9999);
}

TEST(FalconDevice, TheMiddleButtonCloses) {
  FalconBench bench;
  bench.home();
  EXPECT_EQ(bench.sample.tool.grip_ratio, 0.0);
  bench.report.buttons = falcon::kFalconCentre;
  bench.tick();
  EXPECT_EQ(bench.sample.tool.grip_ratio, 1.0);
  bench.report.buttons = falcon::kFalconPlus | falcon::kFalconMinus | falcon::kFalconForward;
  bench.tick();
  EXPECT_EQ(bench.sample.tool.grip_ratio, 0.0);
}

TEST(FalconDevice, IsReadyOnlyWhenItIsHomedAndMayPush) {
  FalconBench bench;
  bench.report = {.counts = {0, 0, 0}, .homed = 0x6};
  bench.run(5);
  EXPECT_FALSE(bench.device.ready());
  bench.home();
  EXPECT_TRUE(bench.device.ready());
  bench.answers = false;
  bench.run(10);
  EXPECT_TRUE(bench.device.ready());  // silence is not lost power
  bench.answers = true;
  bench.device.permit(false);
  bench.run(5);
  EXPECT_TRUE(bench.sample.fresh);
  EXPECT_FALSE(bench.device.ready());
  bench.device.permit(true);
  EXPECT_TRUE(bench.device.ready());
  bench.device.stop();
  EXPECT_FALSE(bench.device.ready());
}

TEST(FalconDevice, NoPermissionMeansNoForceAtOnce) {
  FalconBench bench;
  bench.home();
  bench.tick({2.0, 0.0, 0.0});
  EXPECT_NE(bench.words(), kNoWords);
  bench.device.permit(false);
  bench.tick({2.0, 0.0, 0.0});
  EXPECT_EQ(bench.words(), kNoWords);
  EXPECT_TRUE(bench.sample.fresh);  // where it is stays known
}

TEST(FalconDevice, AForceThatIsNoNumberIsNoForce) {
  FalconBench bench;
  bench.home();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    bench.read();
    EXPECT_EQ(bench.write({bad, 1.0, 1.0}), Fault::kForceNotFinite);
    EXPECT_EQ(bench.words(), kNoWords);
  }
}

TEST(FalconDevice, ReportsWorkspaceDampingStepAndDelayAtTheTool) {
  const DeviceInfo info = FalconBench().device.info();
  EXPECT_EQ(info.workspace_radius_m, 0.04);
  EXPECT_EQ(info.max_torque_Nm, 0.0);
  ASSERT_TRUE(info.at_tool);
  EXPECT_GT(info.at_tool->damping_Ns_per_m, 0.3);
  EXPECT_LT(info.at_tool->damping_Ns_per_m, 3.0);
  EXPECT_GT(info.at_tool->position_step_m, 25e-6);  // 25 to 57 um in the middle, more at the rim
  EXPECT_LT(info.at_tool->position_step_m, 80e-6);
  EXPECT_EQ(info.at_tool->delay_s, 2e-3);
}

TEST(FalconDevice, LeavesTheHeapAlone) {
  FalconBench bench;
  bench.home();
  const NoAlloc guard;
  bench.run(200, {1.0, 2.0, -1.0});
  bench.answers = false;
  bench.run(40, {1.0, 2.0, -1.0});
  EXPECT_EQ(guard.calls(), 0u);
}

TEST(FalconDevice, StopsOnceWithZeroWordsAndARedLight) {
  FalconBench bench;
  bench.home();
  bench.tick({2.0, 0.0, 0.0});
  const int commands = bench.pipe->commands;
  bench.device.stop();
  bench.device.stop();
  EXPECT_EQ(bench.pipe->stops, 1);
  EXPECT_EQ(bench.pipe->last.motor, kNoWords);
  EXPECT_EQ(bench.pipe->last.lights, falcon::kFalconRed);
  bench.tick({2.0, 0.0, 0.0});
  EXPECT_EQ(bench.pipe->commands, commands);
  EXPECT_FALSE(bench.sample.fresh);
}

}  // namespace tact::tests::falcon_device_test
