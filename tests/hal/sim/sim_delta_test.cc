// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/sim_delta.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "hal/sim/sim_delta_model.h"
#include "tests/hal/sim/sim_bench.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::sim::sim_delta_test {

using tests::Bench;
using tests::hand_at;
using tests::kTick_s;
using tests::moving_hand;
using tests::settings;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(SimDelta, SaysWhatItCanDo) {
  const DeviceInfo info = SimDelta(settings(), hand_at({}, 0.0)).info();
  EXPECT_EQ(info.name, "simulated delta 360 x 300 mm");
  EXPECT_EQ(info.max_force_N, 20.0);
  EXPECT_EQ(info.max_torque_Nm, 0.2);
  EXPECT_EQ(info.workspace_radius_m, 0.18);
  EXPECT_EQ(info.workspace_half_length_m, 0.15);
}

TEST(SimDelta, StartsAtRestInTheHand) {
  Bench bench(settings(), hand_at({0.02, 0.03, -0.04}, 300.0));
  const Sample sample = bench.tick();
  EXPECT_TRUE(sample.fresh);
  EXPECT_LT(norm(sample.tool.position_m - Vec3{0.02, 0.03, -0.04}), 0.0202e-3);
  EXPECT_EQ(sample.tool.velocity_mps, Vec3{});
  EXPECT_DOUBLE_EQ(sample.tool.grip_ratio, 0.25);
}

TEST(SimDelta, HoldsItselfAgainstGravityWithoutAHand) {
  Bench bench(settings(), hand_at({0.0, 0.1, -0.05}, 0.0));
  const Vec3 start = bench.delta.true_position_W_m();
  for (int i = 0; i < 2000; ++i) bench.tick();
  EXPECT_LT(norm(bench.delta.true_position_W_m() - start), 1e-6);
}

TEST(SimDelta, ComesToRestAfterAPush) {
  Bench bench(settings(), hand_at({}, 0.0));
  for (int i = 0; i < 60; ++i) bench.tick({.force_N = {1.0, 1.0, 0.0}, .torque_Nm = {}});
  EXPECT_GT(norm(bench.delta.plant().velocity_mps()), 0.05);
  for (int i = 0; i < 4000; ++i) bench.tick();
  EXPECT_LT(norm(bench.delta.plant().velocity_mps()), 1e-6);
}

TEST(SimDelta, FallsWhenItIsStopped) {
  Bench bench(settings(), hand_at({}, 0.0));
  bench.delta.stop();
  bench.delta.stop();
  for (int i = 0; i < 100; ++i) bench.tick({.force_N = {0.0, 0.0, 9.0}, .torque_Nm = {}});
  EXPECT_LT(bench.delta.true_position_W_m().z, -0.02);  // g t^2 / 2 = 49 mm, less for the arms
  EXPECT_GT(bench.delta.true_position_W_m().z, -0.06);
}

TEST(SimDelta, AConstantForceMovesTheHandByForceOverStiffness) {
  const Vec3 force_N{1.2, -0.8, 2.0};
  SimDeviceSettings smooth = settings();
  smooth.joint_friction_Nm = 0.0;
  Bench bench(smooth, hand_at({}, 400.0));
  for (int i = 0; i < 4000; ++i) bench.tick({.force_N = force_N, .torque_Nm = {}});
  EXPECT_LT(norm(bench.delta.true_position_W_m() - force_N / 400.0), 2e-6);
}

TEST(SimDelta, CountingErrsByAtMostTheHalfCount) {
  SimDeviceSettings prompt = settings();
  prompt.sample_delay_s = 0.0;
  Bench bench(prompt, moving_hand());
  double worst_m = 0.0;
  for (int i = 0; i < 1200; ++i) {
    const Sample sample = bench.tick();
    worst_m = std::max(worst_m, norm(sample.tool.position_m - bench.delta.true_position_W_m()));
  }
  EXPECT_LE(worst_m, 0.0202e-3);
  EXPECT_GE(worst_m, 0.005e-3);
}

TEST(SimDelta, ShowsThePastExactlyAsOldAsTheDelay) {
  SimDeviceSettings late = settings();
  for (const double delay_s : {0.25e-3, 0.3e-3, 2e-3, 10e-3}) {
    late.sample_delay_s = delay_s;
    Bench prompt(settings(), moving_hand()), delayed(late, moving_hand());
    // Truth at the time shown, from a twin that is stopped there: same hand, same (zero) force.
    for (int i = 0; i < 400; ++i) prompt.tick(), delayed.tick();
    Sample sample = delayed.tick();
    EXPECT_EQ(sample.stamp_ns, delayed.now_ns - std::llround(delay_s * 1e9));
    SimDelta twin(late, moving_hand());
    double left_s = 401 * kTick_s - delay_s;
    Sample ignored;
    for (; left_s > kTick_s; left_s -= kTick_s) {
      twin.between_ticks(kTick_s);
      (void)twin.read(ignored, 0);
      (void)twin.write({});
    }
    twin.between_ticks(left_s);
    EXPECT_LT(norm(sample.tool.position_m - twin.true_position_W_m()), 0.0202e-3 + 2e-6);
    EXPECT_GT(norm(delayed.delta.true_position_W_m() - twin.true_position_W_m()), 0.1 * delay_s);
  }
}

TEST(SimDelta, CountsSamplesAndVelocityIsThatOfTheTool) {
  Bench bench(settings(), moving_hand());
  std::uint64_t last = 0;
  Vec3 before;
  for (int i = 0; i < 500; ++i) {
    const Sample sample = bench.tick();
    EXPECT_GT(sample.sequence, last);
    last = sample.sequence;
    // the observer lags by 2/w = 8 ms
    if (i == 490) before = direction_W(bench.delta.plant().velocity_mps());
    if (i == 499) EXPECT_LT(norm(sample.tool.velocity_mps - before), 0.004);
  }
  EXPECT_GT(norm(before), 0.1);
}

TEST(SimDelta, TurnsWithTheHandAndGivesWayToTorque) {
  Bench bench(settings(), moving_hand());
  for (int i = 0; i < 2000; ++i) bench.tick();
  const auto turned = model::quat_from_rotation_vector({0.1, 0.2, -0.1});
  EXPECT_NEAR(bench.tick().tool.orientation.y, turned.y, 1e-4);
  for (int i = 0; i < 2000; ++i) bench.tick({.force_N = {}, .torque_Nm = {0.05, 0.0, 0.0}});
  // k r^2 = 300 * 0.05^2 = 0.75 N m/rad: the first axis gives way by 0.067 rad
  EXPECT_GT(bench.tick().tool.orientation.x, turned.x + 0.5 * 0.05);
}

TEST(SimDelta, ForceBeyondTheDeviceIsCutInItsOwnDirection) {
  Bench strong(settings(), hand_at({}, 3000.0)), limited(settings(), hand_at({}, 3000.0));
  for (int i = 0; i < 2000; ++i) {
    strong.tick({.force_N = {60.0, -80.0, 0.0}, .torque_Nm = {}});
    limited.tick({.force_N = {12.0, -16.0, 0.0}, .torque_Nm = {}});
  }
  EXPECT_EQ(strong.delta.true_position_W_m(), limited.delta.true_position_W_m());
  EXPECT_NEAR(norm(strong.delta.true_position_W_m()), 20.0 / 3000.0, 1e-4);
}

TEST(SimDelta, NanForceIsNoForceAndIsReported) {
  Bench bench(settings(), hand_at({}, 300.0));
  bench.tick();
  EXPECT_EQ(bench.delta.write({.force_N = {kNan, 0.0, 0.0}, .torque_Nm = {}}),
            Fault::kForceNotFinite);
  for (int i = 0; i < 50; ++i) bench.delta.between_ticks(kTick_s);
  EXPECT_LT(norm(bench.delta.true_position_W_m()), 1e-6);
}

TEST(SimDelta, ForceIsHeldUntilTheNextWrite) {
  Bench bench(settings(), hand_at({}, 300.0));
  bench.tick({.force_N = {3.0, 0.0, 0.0}, .torque_Nm = {}});
  for (int i = 0; i < 2000; ++i) bench.delta.between_ticks(kTick_s);
  EXPECT_NEAR(bench.delta.true_position_W_m().x, 3.0 / 300.0, 1e-3);
}

TEST(SimDelta, HasTheMisfortunesThatATestAsksFor) {
  Bench bench(settings(), hand_at({}, 300.0));
  bench.tick();
  Sample sample;
  bench.delta.faults().drop_samples = 2;
  for (const bool fresh : {false, false, true}) {
    EXPECT_EQ(bench.delta.read(sample, 0), Fault::kNone);
    EXPECT_EQ(sample.fresh, fresh);
  }
  bench.delta.faults().nan_sample = true;
  EXPECT_EQ(bench.delta.read(sample, 0), Fault::kNone);
  EXPECT_TRUE(std::isnan(sample.tool.position_m.x));
  bench.delta.faults().nan_sample = false;
  bench.delta.faults().device = Fault::kDeviceFailed;
  EXPECT_EQ(bench.delta.read(sample, 0), Fault::kDeviceFailed);
  EXPECT_FALSE(sample.fresh);
  EXPECT_EQ(bench.delta.write({}), Fault::kDeviceFailed);
}

TEST(SimDelta, FollowsTheMouseThatSteersTheHand) {
  Bench bench(settings(), hand_at({}, 300.0));
  for (int i = 0; i < 900; ++i) {
    if (i % 50 == 0) bench.delta.hand_targets().write({.position_m = {0.05, 5.0, 0.0}});
    bench.tick();
  }
  EXPECT_NEAR(bench.delta.true_position_W_m().x, 0.05, 1e-3);
  EXPECT_NEAR(bench.delta.true_position_W_m().y, 0.18, 1e-3);  // no farther than the workspace
}

TEST(SimDelta, ATargetIsAPlaceOfTheToolThatAClutchHasMovedFromTheHandle) {
  Bench bench(settings(), hand_at({0.0, 0.01, 0.0}, 600.0));
  bench.delta.shift_tool({0.05, 0.0, 0.0});
  Sample sample;
  for (int i = 0; i < 1500; ++i) {
    if (i % 50 == 0) bench.delta.hand_targets().write({.position_m = {0.05, 0.02, 0.0}});
    if (i == 750) bench.delta.shift_tool({0.02, 0.0, 0.0});  // while it is steered
    sample = bench.tick();
  }
  EXPECT_LT(norm(sample.tool.position_m - Vec3{0.0, 0.02, 0.0}), 1e-3);
}

TEST(SimDelta, TheSameCallsGiveTheSameBits) {
  Bench one(settings(), moving_hand()), two(settings(), moving_hand());
  for (int i = 0; i < 500; ++i) {
    const Wrench wrench{.force_N = {std::sin(0.1 * i), 0.5, 0.0}, .torque_Nm = {0.0, 0.01, 0.0}};
    const Sample a = one.tick(wrench), b = two.tick(wrench);
    ASSERT_EQ(a.tool.position_m, b.tool.position_m);
    ASSERT_EQ(a.tool.velocity_mps, b.tool.velocity_mps);
    ASSERT_EQ(a.tool.orientation, b.tool.orientation);
  }
}

TEST(SimDelta, WorkOfTheMotorsBoundsItsEnergy) {
  // No hand, no friction, a force that swings: energy is what the motors gave, to the integrator's
  // error, although torques are held for a tick and come from counted and late positions.
  SimDeviceSettings smooth = settings();
  smooth.joint_friction_Nm = 0.0;
  smooth.joint_damping_Nms_per_rad = 0.0;
  model::HandSettings none = hand_at({}, 0.0);
  none.mass_kg = 0.0;
  for (const bool damped : {false, true}) {
    Bench bench(damped ? settings() : smooth, none);
    const delta::DeltaKinematics delta(kGeometry);
    const DeltaPlant& plant = bench.delta.plant();
    double work_J = 0.0, moved_J = 0.0, worst_J = 0.0, least_J = 0.0;
    Vec3 force_N;  // cosines: swings about the start and stays clear of stops and rim
    for (int i = 0; i < 1000; ++i) {
      const Vec3 before = bench.delta.true_position_W_m();
      bench.delta.between_ticks(kTick_s);
      work_J += dot(force_N, bench.delta.true_position_W_m() - before);
      moved_J = std::max(moved_J, std::abs(work_J));
      force_N = {3.0 * std::cos(0.02 * i), 2.0 * std::cos(0.03 * i), 0.0};
      Sample sample;
      (void)bench.delta.read(sample, 0);
      (void)bench.delta.write({.force_N = force_N, .torque_Nm = {}});
      const model::Mat3 mass_kg =
          task_inertia_kg(kGeometry, kMasses, delta.pose(plant.position_D_m(), plant.theta_rad()));
      const double kinetic_J = 0.5 * dot(plant.velocity_mps(), mass_kg * plant.velocity_mps());
      worst_J = std::max(worst_J, kinetic_J - work_J);
      least_J = std::min(least_J, kinetic_J - work_J);
    }
    EXPECT_GE(moved_J, 0.02);
    EXPECT_LE(worst_J, 0.3e-3);
    if (!damped) EXPECT_GE(least_J, -3e-3);
  }
}

TEST(SimDelta, SurvivesOddTimes) {
  SimDelta delta(settings(), moving_hand());
  for (const double odd_s : {0.0, -1.0, kNan, kInfinity, 1e9, 1e-12}) delta.between_ticks(odd_s);
  Sample sample;
  EXPECT_EQ(delta.read(sample, 0), Fault::kNone);
  EXPECT_TRUE(is_finite(sample.tool.position_m));
}

TEST(SimDelta, RefusesSettingsThatNoDeviceHas) {
  const model::HandSettings hand = hand_at({}, 300.0);
  EXPECT_TRUE(make_sim_delta(settings(), hand));
  SimDeviceSettings bad = settings();
  bad.counts_per_turn = 0.0;
  ASSERT_FALSE(make_sim_delta(bad, hand));
  EXPECT_NE(make_sim_delta(bad, hand).error().message.find("counts_per_turn"), std::string::npos);
  bad = settings();
  bad.sample_delay_s = kNan;
  EXPECT_FALSE(make_sim_delta(bad, hand));
  bad = settings();
  bad.sample_delay_s = 0.006;
  ASSERT_FALSE(make_sim_delta(bad, hand)) << "no more than a scene may say";
  EXPECT_EQ(make_sim_delta(bad, hand).error().message,
            "device.sim: sample_delay_s = 0.006; allowed: 0 .. 0.005");
  bad = settings();
  bad.observer_bandwidth_Hz = -1.0;
  EXPECT_FALSE(make_sim_delta(bad, hand));
  EXPECT_FALSE(make_sim_delta(settings(), model::HandSettings{}));  // no waypoint
}

TEST(SimDelta, LeavesTheHeapAlone) {
  Bench bench(settings(), moving_hand());
  bench.tick();
  Sample sample;
  tests::NoAlloc guard;
  bench.delta.between_ticks(kTick_s);
  (void)bench.delta.read(sample, 0);
  (void)bench.delta.write({.force_N = {1.0, 2.0, 3.0}, .torque_Nm = {}});
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::sim::sim_delta_test
