// SPDX-License-Identifier: Apache-2.0
#include "firmware/gate/grip_gate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/gate_settings.h"
#include "tests/support/no_alloc.h"

namespace tact::firmware::gate::grip_gate_test {

constexpr double kPeriod_s = 0.001;

model::Limits limits() {
  model::Limits limits = tests::kRulesLimits;  // 8 N, 1000 N/s, 4 N for long, 6 W, 0.08 J
  limits.grip_force_N = 4.0;
  return limits;
}

/// An armed gate whose fingers are still, and whose ramp-up is over.
class GripGateTest : public testing::Test {
 protected:
  GripGateTest() { ticks(300, 0.0); }

  LimitedGrip tick(double wanted_N, bool fresh = true, bool armed = true) {
    gap_m += kPeriod_s * speed_mps;
    limited = gate.limit({.wanted_N = wanted_N,
                          .gap_m = gap_m,
                          .speed_mps = speed_mps,
                          .fresh = fresh,
                          .armed = armed});
    return limited;
  }
  void ticks(int n, double wanted_N) {
    for (int i = 0; i < n; ++i) tick(wanted_N);
  }

  GripGate gate = *GripGate::make(limits(), kPeriod_s, 1.0);
  double gap_m = 0.02, speed_mps = 0.0;
  LimitedGrip limited;
};

TEST_F(GripGateTest, LetsAModerateForceThrough) {
  ticks(20, 1.5);
  EXPECT_NEAR(limited.force_N, 1.5, 1e-12);
  EXPECT_EQ(limited.acting, Fault::kNone);
  ticks(20, -1.5);
  EXPECT_NEAR(limited.force_N, -1.5, 1e-12);
}

TEST_F(GripGateTest, CutsWhatIsAboveTheLimitOfTheFingers) {
  ticks(50, 100.0);
  EXPECT_LE(limited.force_N, 4.0);
  EXPECT_GT(limited.force_N, 3.9);
  EXPECT_EQ(limited.acting, Fault::kForceLimited);
}

TEST_F(GripGateTest, HasTheSlewInProportion) {
  const double first_N = tick(4.0).force_N;
  EXPECT_GT(first_N, 0.3);
  EXPECT_LE(first_N, 0.5 * 1000.0 * kPeriod_s) << "half of the slew, as of the force";
  EXPECT_EQ(limited.acting, Fault::kSlewLimited);
}

TEST_F(GripGateTest, IsZeroAtOnceWhenNotArmed) {
  ticks(20, 2.0);
  EXPECT_EQ(tick(2.0, true, false).force_N, 0.0);
  EXPECT_LT(tick(2.0).force_N, 0.1) << "it ramps up again";
}

TEST_F(GripGateTest, AForceOrAGapThatIsNoNumberLatches) {
  ticks(20, 2.0);
  EXPECT_EQ(tick(std::nan("")).fault, Fault::kForceNotFinite);
  EXPECT_EQ(limited.force_N, 0.0);
  gap_m = std::numeric_limits<double>::infinity();
  EXPECT_EQ(tick(1.0).fault, Fault::kSampleNotFinite);
  EXPECT_EQ(limited.force_N, 0.0);
}

TEST_F(GripGateTest, RampsDownWithoutSamplesAndThenLatches) {
  ticks(20, 2.0);
  for (int i = 0; i < 12; ++i) tick(2.0, false);
  EXPECT_EQ(limited.force_N, 0.0);
  for (int i = 0; i < 8; ++i) tick(2.0, false);
  EXPECT_EQ(limited.fault, Fault::kDeviceLost);
}

TEST_F(GripGateTest, FallsToTheContinuousForce) {
  ticks(3000, 4.0);
  EXPECT_LE(limited.force_N, 2.01) << "half of 4 N, as of the force";
  EXPECT_GT(limited.force_N, 1.9);
  EXPECT_EQ(limited.acting, Fault::kContinuousLimited);
}

TEST_F(GripGateTest, AForceThatPushesTheFingersApartGivesNoMoreThanItsBudget) {
  // What a broken law would do: it always pushes along the motion of the fingers.
  double given_energy_J = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    speed_mps = i / 50 % 2 == 0 ? 0.3 : -0.3;
    const double held_N = limited.force_N;
    tick(std::copysign(4.0, speed_mps));
    given_energy_J += held_N * speed_mps * kPeriod_s;
    ASSERT_EQ(limited.fault, Fault::kNone) << i;
  }
  EXPECT_LE(given_energy_J, 0.5 * 0.08 + 0.5 * 1e-4 * 20.0 + 1e-9);
  EXPECT_GT(given_energy_J, 0.5 * 0.5 * 0.08) << "the case reached the brake";
}

TEST_F(GripGateTest, HoldsThePowerOnTheFingers) {
  speed_mps = 0.95;
  gap_m = -0.5;
  for (int i = 0; i < 200; ++i) {
    tick(-4.0);
    ASSERT_LE(-limited.force_N * -speed_mps, 3.0);
  }
  speed_mps = 0.9;
  for (int i = 0; i < 100; ++i) {
    tick(4.0);
    ASSERT_LE(limited.force_N * speed_mps, 3.0 + 1e-9) << "half of 6 W";
  }
}

TEST_F(GripGateTest, NeedsNoHeap) {
  const tests::NoAlloc guard;
  ticks(50, 3.0);
  EXPECT_EQ(guard.calls(), 0u);
}

TEST(GripGate, NoGripGateWhereTheGripOrForceLimitIsZero) {
  model::Limits none = limits();
  none.grip_force_N = 0.0;
  EXPECT_FALSE(GripGate::make(none, kPeriod_s, 1.0));
  none = limits();
  none.force_N = 0.0;
  EXPECT_FALSE(GripGate::make(none, kPeriod_s, 1.0));
}

TEST(GripGate, AQuarterOfTheForceIsAQuarterOnTheFingers) {
  GripGate gate = *GripGate::make(limits(), kPeriod_s, kNonRtForceShare);
  double most_N = 0.0;
  for (int i = 0; i < 500; ++i)
    most_N = std::max(
        most_N, gate.limit({.wanted_N = 4.0, .gap_m = 0.02, .fresh = true, .armed = true}).force_N);
  EXPECT_LE(most_N, 1.0);
  EXPECT_GT(most_N, 0.7);
}

}  // namespace tact::firmware::gate::grip_gate_test
