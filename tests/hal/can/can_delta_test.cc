// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_delta.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "hal/can/can_settings.h"
#include "hal/mounting.h"
#include "hal/sim/sim_delta_model.h"
#include "model/units.h"
#include "tests/support/can_bench.h"
#include "tests/support/mountings.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::can::can_delta_test {

using tests::jig_settings;
using tests::published_pose;

/// Turns of the motors for these angles, by the header's first line.
delta::Joints turns_for(const delta::Joints& theta_rad, const model::DeviceSettings& settings) {
  const auto &zero = settings.of<CanSettings>().zero_turns,
             &sign = settings.of<CanSettings>().direction;
  delta::Joints out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = zero[i] + sign[i] * theta_rad[i] * settings.of<DeltaSettings>().gear_ratio / 2 /
                           std::numbers::pi;
  return out;
}

model::DeviceSettings absolute_settings() {
  model::DeviceSettings settings = tests::example_delta();
  settings.of<CanSettings>().homing = Homing::kAbsolute;
  settings.of<CanSettings>().zero_turns = {0.25, -3.0, 100.0};
  settings.of<CanSettings>().direction = {1.0, -1.0, -1.0};
  return settings;
}

TEST(CanDelta, TurnsBecomeThePublishedPoses) {
  const auto settings = absolute_settings();
  for (std::size_t index = 0; index < 5; ++index) {
    const auto pose = published_pose(index);
    CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>());
    Tool tool;
    ASSERT_FALSE(delta.measure(turns_for(pose.theta_rad, settings), 1'000'000, tool));
    EXPECT_NEAR(tool.position_m.x, pose.position_D_m.z - 0.345, 1e-9);
    EXPECT_NEAR(tool.position_m.y, -pose.position_D_m.y, 1e-9);
    EXPECT_NEAR(tool.position_m.z, pose.position_D_m.x, 1e-9);
    EXPECT_EQ(tool.orientation, model::Quat{});
    EXPECT_EQ(tool.grip_ratio, 0.0);
  }
}

TEST(CanDelta, HoldsItsArmsAgainstGravityInSixMountings) {
  const auto settings = absolute_settings();
  const auto pose = published_pose();
  const delta::DeltaKinematics kinematics(settings.of<DeltaSettings>());
  for (const auto& one : tests::kMountings) {
    CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>(),
                   mounting_of(tests::settings_of(one)).gravity_in_base_mps2());
    Tool tool;
    ASSERT_FALSE(delta.measure(turns_for(pose.theta_rad, settings), 1'000'000, tool));
    const delta::Joints motors_Nm = delta.motor_torques_Nm({});
    // Down in the axes of D, by hand: x of the base is z of D, z is x, y is -y.
    const Vec3 down_D{one.down_B.z, -one.down_B.y, one.down_B.x};
    const delta::Joints held_Nm = gravity_torques_Nm(
        kinematics.geometry(), settings.of<DeltaSettings>(),
        kinematics.pose(pose.position_D_m, pose.theta_rad), model::kGravity_mps2 * down_D);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(motors_Nm[i],
                  settings.of<CanSettings>().direction[i] * held_Nm[i] /
                      settings.of<DeltaSettings>().gear_ratio,
                  1e-9)
          << one.words << ", arm " << i;
  }
}

TEST(CanDelta, AJigSetsTheZeroWhereverTheEncodersBegan) {
  const auto pose = published_pose();
  const auto settings = jig_settings(pose);
  CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>());
  const delta::Joints turns{12.5, -7.25, 1e4};
  delta.home_on_jig(turns);
  const delta::Joints theta = delta.theta_rad(turns);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(theta[i], pose.theta_rad[i], 1e-9);
  // One motor turn is 36 degrees of the arm at 10:1, up or down.
  const delta::Joints next = delta.theta_rad({13.5, -6.25, 1e4 + 1});
  EXPECT_NEAR(next[0] - theta[0], 0.2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(next[1] - theta[1], -0.2 * std::numbers::pi, 1e-9);
}

TEST(CanDelta, MotorPowerIsThePowerAtTheHand) {
  // sum tau_motor omega_motor = F . v, gravity aside: gear and signs cannot both be wrong.
  const auto settings = absolute_settings();
  const auto pose = published_pose(2);
  CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>());
  const Vec3 force{2.0, -1.0, 3.0};
  const double h_s = 1e-3;
  const delta::Joints turns = turns_for(pose.theta_rad, settings);
  Tool at, later;
  delta.measure(turns, 0, at);
  const delta::Joints with = delta.motor_torques_Nm(force), without = delta.motor_torques_Nm({});
  const delta::Joints step_turns{3e-6, 5e-6, -2e-6};
  delta::Joints moved = turns;
  for (std::size_t i = 0; i < 3; ++i) moved[i] += step_turns[i];
  delta.measure(moved, 1'000'000, later);
  double motor_W = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    motor_W += (with[i] - without[i]) * step_turns[i] * 2.0 * std::numbers::pi / h_s;
  const double hand_W = dot(force, (later.position_m - at.position_m) / h_s);
  EXPECT_NEAR(motor_W, hand_W, 1e-4 * std::abs(hand_W));
}

TEST(CanDelta, ForceAboveTheLimitKeepsItsDirection) {
  const auto settings = absolute_settings();
  CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>());
  Tool tool;
  delta.measure(turns_for(published_pose().theta_rad, settings), 0, tool);
  const Vec3 along = normalized(Vec3{1.0, 2.0, -2.0});
  const delta::Joints most = delta.motor_torques_Nm(20.0 * along),
                      more = delta.motor_torques_Nm(1e6 * along);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(more[i], most[i], 1e-12);
}

TEST(CanDelta, NoTorqueIsEverAboveTheLimitOfAnArm) {
  auto settings = absolute_settings();
  settings.of<DeltaSettings>().max_joint_torque_Nm = 0.3;  // less than gravity alone
  CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>());
  Tool tool;
  delta.measure(turns_for(published_pose().theta_rad, settings), 0, tool);
  for (const double size_N : {0.0, 1.0, 20.0})
    for (const double torque_Nm : delta.motor_torques_Nm({size_N, -size_N, size_N}))
      EXPECT_LE(std::abs(torque_Nm), 0.03 + 1e-12);
}

TEST(CanDelta, MissingPoseGivesZeroTorqueAndNonFiniteForceGravityOnly) {
  const auto settings = absolute_settings();
  CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>());
  EXPECT_EQ(delta.motor_torques_Nm({1.0, 1.0, 1.0}), delta::Joints{});
  Tool tool;
  delta.measure(turns_for(published_pose().theta_rad, settings), 0, tool);
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), inf, -inf})
    EXPECT_EQ(delta.motor_torques_Nm({0.0, bad, 0.0}), delta.motor_torques_Nm({}));
}

TEST(CanDelta, AnglesWithoutAPoseLoseTheHomingAndKeepTheLastPose) {
  const auto settings = absolute_settings();
  CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>());
  Tool tool;
  tool.position_m = {1.0, 2.0, 3.0};
  const double nan = std::nan("");
  for (const delta::Joints& theta : {delta::Joints{1.72, 0.0, 0.0}, delta::Joints{0.0, -0.95, 0.0},
                                     delta::Joints{0.0, nan, 0.0}, delta::Joints{0.0, 0.0, 1e9}}) {
    const auto lost = delta.measure(turns_for(theta, settings), 0, tool);
    ASSERT_TRUE(lost);
    EXPECT_EQ(lost->fault, Fault::kHomingLost);
    EXPECT_FALSE(homing_fault_detail(*lost, settings.of<DeltaSettings>()).empty());
    EXPECT_TRUE(delta.check_home(turns_for(theta, settings)));
  }
  EXPECT_EQ(tool.position_m, (Vec3{1.0, 2.0, 3.0}));
  EXPECT_EQ(delta.motor_torques_Nm({1.0, 0.0, 0.0}), delta::Joints{});
  // Two degrees beyond a stop are the stop's own compliance.
  EXPECT_FALSE(delta.check_home(turns_for({1.68, 1.68, 1.68}, settings)));
}

TEST(CanDelta, RodsThatCannotMeetLoseTheHoming) {
  auto settings = absolute_settings();
  settings.of<DeltaSettings>().forearm_m = 0.2;
  const CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>());
  const auto error = delta.check_home(turns_for({0.0, 0.0, 0.0}, settings));
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("no platform can lie"), std::string::npos);
}

TEST(CanDelta, VelocityAfterAGapIsThatOfTheGap) {
  const auto settings = absolute_settings();
  const auto pose = published_pose();
  CanDelta delta(settings.of<DeltaSettings>(), settings.of<CanSettings>());
  delta::Joints theta = pose.theta_rad;
  Tool tool;
  std::int64_t now_ns = 0;
  const auto step = [&](std::int64_t elapsed_ns) {
    now_ns += elapsed_ns;
    for (double& one : theta) one += 1e-4;
    const tests::NoAlloc guard;
    ASSERT_FALSE(delta.measure(turns_for(theta, settings), now_ns, tool));
    ASSERT_EQ(guard.calls(), 0u);
  };
  for (int i = 0; i < 50; ++i) step(1'000'000);
  EXPECT_GT(norm(tool.velocity_mps), 0.005);
  const Vec3 before_m = tool.position_m;
  step(25'000'000);
  const double mean_mps = norm(tool.position_m - before_m) / 0.025;
  EXPECT_GE(norm(tool.velocity_mps), 0.9 * mean_mps) << "and not zero";
  EXPECT_LE(norm(tool.velocity_mps), 1.5 * mean_mps);
}

TEST(CanDelta, ReportsForceLimitDelayAndPositionStepAtTheTool) {
  const auto settings = absolute_settings();
  const auto info = CanDelta(settings.of<DeltaSettings>(), settings.of<CanSettings>())
                        .info("x", 100'000.0, 1.5e-3);
  ASSERT_TRUE(info.at_tool);
  EXPECT_EQ(info.max_force_N, 20.0);
  EXPECT_EQ(info.at_tool->delay_s, 1.5e-3);
  EXPECT_NEAR(info.at_tool->position_step_m, 2.36e-5, 0.02e-5);  // the known worst corner
  EXPECT_EQ(info.damping_key, "device.delta.joint_damping_Nms_per_rad");
}

}  // namespace tact::hal::can::can_delta_test
