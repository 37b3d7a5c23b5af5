// SPDX-License-Identifier: Apache-2.0
// The independent simulation of the loop against closed formulas, so that the maps can be believed.
#include "tools/stability/loop/haptic_loop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/law/haptic_limit.h"
#include "tools/stability/loop/gate_monitor.h"

namespace tact::tools::stability::haptic_loop_test {

LoopCase bare(double damping_Ns_per_m, double delay_s = 0.0, double rate_Hz = 1000.0) {
  LoopCase loop;
  loop.device.damping_Ns_per_m = damping_Ns_per_m;
  loop.device.delay_s = delay_s;
  loop.rate_Hz = rate_Hz;
  return loop;
}
TissueForce wall(double stiffness_N_per_m) {
  return [=](double depth_m) { return stiffness_N_per_m * depth_m; };
}
double theory(const LoopCase& loop) {
  return model::law::haptic_limit(loop.device, loop.rate_Hz, 0.0, loop.lost_share).grow_N_per_m;
}

TEST(HapticLoop, LosesStabilityAtTwiceDampingOverPeriod) {
  for (const double rate_Hz : {500.0, 2000.0})
    for (const double damping : {0.3, 3.0}) {
      const LoopCase loop = bare(damping, 0.0, rate_Hz);
      EXPECT_NEAR(largest_wall_N_per_m(loop, Verdict::kGrow) / (2.0 * damping * rate_Hz), 1.0,
                  0.03);
    }
}

TEST(HapticLoop, DelayCountsTwiceAsMuchAsTheHold) {
  for (const double delay_s : {0.3e-3, 1e-3, 2.5e-3}) {
    const LoopCase loop = bare(1.0, delay_s);
    EXPECT_NEAR(largest_wall_N_per_m(loop, Verdict::kGrow) / (1.0 / (0.5e-3 + delay_s)), 1.0, 0.03);
  }
}

TEST(HapticLoop, WithoutAnyDampingNoWallIsStable) {
  EXPECT_EQ(run_loop(bare(0.0), wall(20.0)).verdict, Verdict::kGrow);
}

TEST(HapticLoop, CountsWithoutFrictionBuzzButDoNotGrow) {
  LoopCase loop = bare(2.0);
  loop.device.position_step_m = 24e-6;
  loop.balance_m = between_counts_m(0.01, 24e-6);
  const LoopRun run = run_loop(loop, wall(0.5 * theory(loop)));
  EXPECT_EQ(run.verdict, Verdict::kBuzz);
  EXPECT_GT(run.last_swing_m, 1e-7);
  EXPECT_LT(run.last_swing_m, 5.0 * 24e-6) << "a few counts";
}

TEST(HapticLoop, FrictionCarriesHalfACountUpToTwiceFrictionOverStep) {
  LoopCase loop = bare(10.0);
  loop.device.position_step_m = 50e-6;
  loop.device.friction_N = 0.1;
  EXPECT_NEAR(largest_wall_N_per_m(loop, Verdict::kBuzz) / 4000.0, 1.0, 0.03);  // 2 c / D
  EXPECT_GT(largest_wall_N_per_m(loop, Verdict::kGrow), 15'000.0);
}

TEST(HapticLoop, HandRaisesTheStableWallStiffness) {
  LoopCase loop = bare(1.0);
  loop.hand = {.mass_kg = 0.15, .stiffness_N_per_m = 600.0, .damping_Ns_per_m = 15.0};
  EXPECT_GT(largest_wall_N_per_m(loop, Verdict::kGrow), 5.0 * theory(loop));
}

TEST(HapticLoop, LostTicksCostWhatTheMeanSquareOfTheHoldsSays) {
  LoopCase loop = bare(2.0);
  loop.lost_share = 0.3;
  loop.duration_s = 10.0;
  EXPECT_NEAR(largest_wall_N_per_m(loop, Verdict::kGrow) / theory(loop), 1.0, 0.15);
}

TEST(HapticLoop, TheSameSeedGivesTheSameRun) {
  LoopCase loop = bare(2.0);
  loop.lost_share = 0.3;
  const LoopRun a = run_loop(loop, wall(1000.0)), b = run_loop(loop, wall(1000.0));
  EXPECT_EQ(a.last_swing_m, b.last_swing_m);
  loop.seed = 2;
  EXPECT_NE(run_loop(loop, wall(1000.0)).last_swing_m, a.last_swing_m);
}

TEST(HapticLoop, BeyondTheLineTheGateKeepsForceAndSlewWithinLimits) {
  for (const double rate_Hz : {500.0, 1000.0, 4000.0}) {
    LoopCase loop = bare(0.5, 0.5e-3, rate_Hz);
    const double stiffness = 5.0 * theory(loop);
    loop.balance_m = 2.0 / stiffness;
    GateMonitor gate(rate_Hz);
    gate.open(2.0);
    const LoopRun run = run_loop(loop, wall(stiffness), [&](double wanted_N, bool fresh) {
      return gate.step(wanted_N, fresh);
    });
    EXPECT_GT(run.max_force_N, 0.9 * kSceneLimits.force_N) << "it really fights the limits";
    EXPECT_LE(run.max_force_N, kSceneLimits.force_N);
    EXPECT_LE(run.max_step_N, kSceneLimits.slew_N_per_s / rate_Hz + 1e-12);
    EXPECT_TRUE(gate.kept_bounds());
  }
}

TEST(HapticLoop, GateMonitorKeepsTheForceLimitAndLatchesLostSamples) {
  GateMonitor gate(1000.0);
  gate.open(0.0);
  for (int i = 0; i < 100; ++i) gate.step(100.0, true);
  EXPECT_NEAR(gate.written_N(), kSceneLimits.force_N, 1e-9);
  EXPECT_TRUE(gate.kept_bounds());
  for (int i = 0; i < 20; ++i) gate.step(100.0, false);
  EXPECT_TRUE(gate.is_latched());
  EXPECT_EQ(gate.written_N(), 0.0);
}

}  // namespace tact::tools::stability::haptic_loop_test
