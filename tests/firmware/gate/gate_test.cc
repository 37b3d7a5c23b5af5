// SPDX-License-Identifier: Apache-2.0
#include "firmware/gate/gate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/no_alloc.h"

namespace tact::firmware::gate::gate_test {

constexpr double kPeriod_s = 0.001;
constexpr model::Limits kLimits{.force_N = 8.0,
                                .torque_Nm = 0.2,
                                .slew_N_per_s = 1000.0,
                                .ramp_s = 0.5,
                                .workspace_radius_m = 0.18,
                                .workspace_half_length_m = 0.15};

GateInput wanting(const Vec3& force_N) {
  return {.wanted = {force_N, {}}, .tool = {}, .fresh = true, .armed = true};
}

// A gate that has been armed long enough to be fully open and already passes this force.
Gate open_gate(const Vec3& force_N = {}) {
  Gate gate(kLimits, kPeriod_s, 1.0);
  for (int i = 0; i < 1000; ++i) gate.limit(wanting(force_N));
  return gate;
}

std::uint64_t count(const Gate& gate, Stage stage) {
  return gate.counters()[static_cast<std::size_t>(stage)];
}

TEST(Gate, PassesASmallSteadyForceUnchanged) {
  Gate gate = open_gate({0.1, -0.2, 0.3});
  const LimitedForce v = gate.limit(wanting({0.1, -0.2, 0.3}));
  EXPECT_EQ(v.wrench.force_N, (Vec3{0.1, -0.2, 0.3}));
  EXPECT_EQ(v.acting, Fault::kNone);
}

TEST(Gate, IsShutUnlessArmed) {
  Gate gate(kLimits, kPeriod_s, 1.0);
  GateInput input = wanting({1, 0, 0});
  input.armed = false;
  const LimitedForce v = gate.limit(input);
  EXPECT_EQ(v.wrench, Wrench{});
  EXPECT_EQ(v.acting, Fault::kNotArmed);
  EXPECT_EQ(count(gate, Stage::kArmed), 1u);
}

TEST(Gate, NotANumberGivesZeroAtOnceAndLatches) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Gate gate = open_gate({1, 0, 0});
    const LimitedForce v = gate.limit(wanting({bad, 0, 0}));
    EXPECT_EQ(v.wrench, Wrench{});
    EXPECT_EQ(v.fault, Fault::kForceNotFinite);
    EXPECT_EQ(count(gate, Stage::kFinite), 1u);
  }
}

TEST(Gate, TheFirstFaultOfATickIsReported) {
  Gate gate = open_gate({1, 0, 0});
  GateInput input = wanting({std::nan(""), 0, 0});
  input.tool.position_m.x = std::nan("");
  const LimitedForce v = gate.limit(input);
  EXPECT_EQ(v.fault, Fault::kSampleNotFinite) << "a law that gets no number gives none";
  EXPECT_EQ(v.wrench, Wrench{});
}

TEST(Gate, OneMissedSampleHoldsTheForce) {
  Gate gate = open_gate({1, 0, 0});
  GateInput stale = wanting({1, 0, 0});
  stale.fresh = false;
  const LimitedForce v = gate.limit(stale);
  EXPECT_NEAR(v.wrench.force_N.x, 1.0, 1e-12);
  EXPECT_EQ(v.acting, Fault::kSampleHeld);
}

TEST(Gate, FromTheSecondMissedSampleForceRampsDownIn10ms) {
  Gate gate = open_gate({1, 0, 0});
  GateInput stale = wanting({1, 0, 0});
  stale.fresh = false;
  gate.limit(stale);
  double before_N = 1.0;
  for (int i = 0; i < 10; ++i) {
    const LimitedForce v = gate.limit(stale);
    EXPECT_LT(v.wrench.force_N.x, before_N);
    EXPECT_EQ(v.acting, Fault::kSampleStale);
    before_N = v.wrench.force_N.x;
  }
  EXPECT_NEAR(before_N, 0.0, 1e-12);
}

TEST(Gate, TwentyMissedSamplesInARowLoseTheDevice) {
  Gate gate = open_gate();
  GateInput stale = wanting({});
  stale.fresh = false;
  for (int i = 1; i < 20; ++i) EXPECT_EQ(gate.limit(stale).fault, Fault::kNone) << i;
  EXPECT_EQ(gate.limit(stale).fault, Fault::kDeviceLost);
  // One good sample in between starts the count again.
  Gate other = open_gate();
  for (int i = 0; i < 19; ++i) other.limit(stale);
  other.limit(wanting({}));
  EXPECT_EQ(other.limit(stale).fault, Fault::kNone);
}

// A loop of so many periods a tick, without samples.
GateInput late_and_missing(const Vec3& force_N, std::uint32_t skipped_periods) {
  GateInput input = wanting(force_N);
  input.fresh = false;
  input.skipped_periods = skipped_periods;
  return input;
}

TEST(Gate, ALateLoopRampsDownInTenMillisecondsNotTenTicks) {
  Gate two = open_gate({4, 0, 0});  // two periods a tick: 2, 4, .. samples are missing
  for (const double left : {0.9, 0.7, 0.5, 0.3, 0.1, 0.0}) {
    const LimitedForce v = two.limit(late_and_missing({4, 0, 0}, 1));
    EXPECT_NEAR(v.wrench.force_N.x, 4.0 * left, 1e-12);
    EXPECT_EQ(v.acting, Fault::kSampleStale);
    EXPECT_EQ(v.fault, Fault::kNone);
  }
  Gate five = open_gate({8, 0, 0});  // more than one period's slew in a tick, as more time passed
  for (const double left : {0.6, 0.1, 0.0})
    EXPECT_LE(five.limit(late_and_missing({8, 0, 0}, 4)).wrench.force_N.x, 8.0 * left + 1e-12);
}

TEST(Gate, AForceFarAboveItsLimitRampsDownInTenMilliseconds) {
  GateInput much = wanting({1000, 0, 0});
  much.wanted.torque_Nm = {0, 0, 50};
  Gate gate = open_gate();
  for (int i = 0; i < 100; ++i) gate.limit(much);
  much.fresh = false;
  for (int missed = 1; missed <= 11; ++missed) {
    const Wrench w = gate.limit(much).wrench;
    EXPECT_LE(w.force_N.x, 8.0 * (1.0 - 0.1 * (missed - 1)) + 1e-12) << missed;
    EXPECT_LE(w.torque_Nm.z, 0.2 * (1.0 - 0.1 * (missed - 1)) + 1e-12) << missed;
  }
}

TEST(Gate, TwentyPeriodsWithoutASampleLoseTheDeviceInHoweverFewTicks) {
  Gate two = open_gate();
  for (int tick = 1; tick < 10; ++tick)
    EXPECT_EQ(two.limit(late_and_missing({}, 1)).fault, Fault::kNone) << tick;
  EXPECT_EQ(two.limit(late_and_missing({}, 1)).fault, Fault::kDeviceLost);
  Gate once = open_gate({1, 0, 0});
  EXPECT_EQ(once.limit(late_and_missing({1, 0, 0}, 19)).fault, Fault::kDeviceLost);
  Gate late = open_gate({1, 0, 0});
  GateInput fresh = wanting({1, 0, 0});
  fresh.skipped_periods = 19;
  EXPECT_EQ(late.limit(fresh).acting, Fault::kNone) << "a sample after all: nothing is missing";
}

TEST(Gate, AfterALateTickAForceGrowsByOnePeriodsSlew) {
  Gate gate = open_gate();
  GateInput late = wanting({8, 0, 0});
  late.skipped_periods = 4;
  EXPECT_LE(gate.limit(late).wrench.force_N.x, 1.0);
  GateInput back = wanting({8, 0, 0});
  Gate ramped = open_gate({8, 0, 0});
  for (int i = 0; i < 11; ++i) ramped.limit(late_and_missing({8, 0, 0}, 0));
  back.skipped_periods = 4;
  EXPECT_LE(ramped.limit(back).wrench.force_N.x, 1.0);
}

TEST(Gate, ALateLoopRampsDownOutsideTheWorkspaceInFiftyMilliseconds) {
  Gate gate = open_gate({1, 0, 0});
  GateInput outside = wanting({1, 0, 0});
  outside.tool.position_m = {0, 0.19, 0};
  outside.skipped_periods = 4;
  for (int tick = 1; tick <= 10; ++tick)
    EXPECT_NEAR(gate.limit(outside).wrench.force_N.x, 1.0 - 0.1 * tick, 1e-12);
}

TEST(Gate, OutsideTheWorkspaceTheForceRampsDownAndBackInside) {
  Gate gate = open_gate({1, 0, 0});
  GateInput outside = wanting({1, 0, 0});
  outside.tool.position_m = {0, 0.19, 0};
  const LimitedForce first = gate.limit(outside);
  EXPECT_GT(first.wrench.force_N.x, 0.9) << "ramps down, no step";
  EXPECT_EQ(first.acting, Fault::kOutsideWorkspace);
  for (int i = 0; i < 60; ++i) gate.limit(outside);
  EXPECT_EQ(gate.limit(outside).wrench.force_N.x, 0.0);
  for (int i = 0; i < 60; ++i) gate.limit(wanting({1, 0, 0}));
  EXPECT_NEAR(gate.limit(wanting({1, 0, 0})).wrench.force_N.x, 1.0, 1e-12);
  outside.tool.position_m = {-0.151, 0, 0};  // against the force: it takes the energy
  EXPECT_EQ(gate.limit(outside).acting, Fault::kOutsideWorkspace);
}

TEST(Gate, LimitsTheMagnitudeAndKeepsTheDirection) {
  Gate gate = open_gate({30, 40, 0});
  const LimitedForce v = gate.limit(wanting({30, 40, 0}));
  EXPECT_NEAR(norm(v.wrench.force_N), 8.0, 1e-9);
  EXPECT_NEAR(v.wrench.force_N.x / v.wrench.force_N.y, 0.75, 1e-12);
  EXPECT_EQ(v.acting, Fault::kForceLimited);
}

TEST(Gate, WithoutHardRealTimeAQuarterOfTheForceIsLeft) {
  Gate gate(kLimits, kPeriod_s, 0.25);
  Vec3 last;
  for (int i = 0; i < 1000; ++i) last = gate.limit(wanting({100, 0, 0})).wrench.force_N;
  EXPECT_NEAR(last.x, 2.0, 1e-9);
}

TEST(Gate, LimitsTheTorque) {
  Gate gate = open_gate();
  GateInput twist = wanting({});
  twist.wanted.torque_Nm = {0, 0, 5};
  LimitedForce v;
  for (int i = 0; i < 100; ++i) v = gate.limit(twist);
  EXPECT_NEAR(v.wrench.torque_Nm.z, 0.2, 1e-9);
  EXPECT_EQ(v.acting, Fault::kTorqueLimited);
}

TEST(Gate, RampsUpAfterArming) {
  Gate gate(kLimits, kPeriod_s, 1.0);
  double before_N = -1.0;
  for (int i = 1; i <= 500; ++i) {
    const double force_N = gate.limit(wanting({1, 0, 0})).wrench.force_N.x;
    EXPECT_GT(force_N, before_N);
    EXPECT_NEAR(force_N, i / 500.0, 0.01);
    before_N = force_N;
  }
  GateInput off = wanting({1, 0, 0});
  off.armed = false;
  gate.limit(off);
  EXPECT_LT(gate.limit(wanting({1, 0, 0})).wrench.force_N.x, 0.01) << "arming again ramps again";
}

TEST(Gate, TooFastTheForceRampsDownAndBackWhenItIsSlow) {
  Gate gate = open_gate({0.1, 0, 0});
  GateInput fast = wanting({0.1, 0, 0});
  fast.tool.velocity_mps = {0, 1.6, 0};
  const LimitedForce first = gate.limit(fast);
  EXPECT_GT(first.wrench.force_N.x, 0.09) << "ramps down, no step";
  EXPECT_EQ(first.acting, Fault::kTooFast);
  for (int i = 0; i < 60; ++i) gate.limit(fast);
  EXPECT_EQ(gate.limit(fast).wrench.force_N.x, 0.0);
  for (int i = 0; i < 60; ++i) gate.limit(wanting({0.1, 0, 0}));
  EXPECT_EQ(gate.limit(wanting({0.1, 0, 0})).acting, Fault::kNone);
  fast.tool.velocity_mps = {};
  fast.tool.angular_velocity_radps = {0, 0, 11};
  EXPECT_EQ(gate.limit(fast).acting, Fault::kTooFast) << "turning counts too";
}

TEST(Gate, AToolThatSpeedsUpAsAHandDoesMeetsThePowerLimitWithoutAStop) {
  model::Limits limits = kLimits;
  limits.power_W = 4.0;
  Gate gate(limits, kPeriod_s, 1.0);
  for (int i = 0; i < 1000; ++i) gate.limit(wanting({7, 0, 0}));
  GateInput input = wanting({7, 0, 0});
  double most_W = 0.0;
  for (; input.tool.velocity_mps.x < 1.4; input.tool.velocity_mps.x += 0.02) {  // 20 m/s2
    const LimitedForce v = gate.limit(input);
    ASSERT_EQ(v.fault, Fault::kNone);
    most_W = std::max(most_W, v.wrench.force_N.x * input.tool.velocity_mps.x);
  }
  EXPECT_NEAR(most_W, 3.0, 0.01) << "three quarters of the limit";
  EXPECT_EQ(gate.limit(input).acting, Fault::kPowerLimited);
  input.tool.velocity_mps.x = 50.0;  // in one tick: no slew can follow
  const LimitedForce v = gate.limit(input);
  EXPECT_EQ(v.fault, Fault::kPowerExceeded);
  EXPECT_EQ(v.wrench, Wrench{});
}

TEST(Gate, AJumpUnderForceOverdrawsTheTankAndLatchesUntilDisarmed) {
  Gate gate = open_gate({2, 0, 0});
  GateInput jump = wanting({2, 0, 0});
  jump.tool.position_m.x = 0.06;  // 2 N * 60 mm = 0.12 J, of 0.1 J
  EXPECT_EQ(gate.limit(jump).fault, Fault::kEnergyOverdrawn);
  EXPECT_EQ(gate.limit(jump).fault, Fault::kEnergyOverdrawn);
  EXPECT_NEAR(gate.given_energy_J(), 0.12, 1e-6);
  jump.armed = false;
  EXPECT_EQ(gate.limit(jump).fault, Fault::kNone);
  EXPECT_EQ(gate.given_energy_J(), 0.0);
}

TEST(Gate, AFaultFoundWhileArmedIsZeroInTheSameTick) {
  Gate gate = open_gate({1, 0, 0});
  GateInput bad = wanting({1, 0, 0});
  bad.tool.velocity_mps.y = std::nan("");
  const LimitedForce v = gate.limit(bad);
  EXPECT_EQ(v.fault, Fault::kSampleNotFinite);
  EXPECT_EQ(v.wrench, Wrench{});
}

TEST(Gate, LeavesTheHeapAlone) {
  Gate gate = open_gate();
  const tests::NoAlloc guard;
  for (int i = 0; i < 100; ++i) gate.limit(wanting({100, 0, 0}));
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::firmware::gate::gate_test
