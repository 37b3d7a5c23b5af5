// SPDX-License-Identifier: Apache-2.0
#include "model/law/haptic_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/no_alloc.h"

namespace tact::model::law::haptic_limit_test {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr DeviceAtTool kDevice{
    .damping_Ns_per_m = 2.0, .friction_N = 0.06, .position_step_m = 24e-6, .delay_s = 0.5e-3};

TEST(HapticLimit, MatchesPenAndPaper) {
  const tests::NoAlloc guard;
  // 2 / (0.0005 + 0.0005) = 2000 N/m;  2 * 0.06 / 24e-6 = 5000 N/m
  const HapticLimit limit = haptic_limit(kDevice, 1000.0);
  EXPECT_NEAR(limit.grow_N_per_m, 2000.0, 1e-9);
  EXPECT_NEAR(limit.quiet_N_per_m, 5000.0, 1e-9);
  EXPECT_NEAR(limit.safe_N_per_m(), 2000.0, 1e-9);
  EXPECT_EQ(guard.calls(), 0u);
}

TEST(HapticLimit, IsTwiceDampingOverPeriodWithoutDelay) {
  // Colgate and Schenkel: b > K T / 2 + |B|
  const DeviceAtTool device{.damping_Ns_per_m = 3.0};
  for (const double rate_Hz : {250.0, 1000.0, 4000.0}) {
    EXPECT_NEAR(haptic_limit(device, rate_Hz).grow_N_per_m, 2.0 * 3.0 * rate_Hz, 1e-9);
    for (const double virtual_damping : {1.0, -1.0})
      EXPECT_NEAR(haptic_limit(device, rate_Hz, virtual_damping).grow_N_per_m, 4.0 * rate_Hz, 1e-9);
  }
  EXPECT_EQ(haptic_limit(device, 1000.0, 3.0).grow_N_per_m, 0.0) << "all damping is used up";
  EXPECT_EQ(haptic_limit(device, 1000.0, 4.0).grow_N_per_m, 0.0);
}

TEST(HapticLimit, HasNoCountLimitWithoutCountsAndNoRestWithoutFriction) {
  EXPECT_EQ(haptic_limit({.damping_Ns_per_m = 1.0}, 1000.0).quiet_N_per_m, kInf);
  const DeviceAtTool slippery{.damping_Ns_per_m = 1.0, .position_step_m = 1e-5};
  EXPECT_EQ(haptic_limit(slippery, 1000.0).quiet_N_per_m, 0.0);
  EXPECT_GT(haptic_limit(slippery, 1000.0).grow_N_per_m, 0.0) << "it buzzes, it does not grow";
}

TEST(HapticLimit, LostTicksCostStiffness) {
  const DeviceAtTool device{.damping_Ns_per_m = 2.0};
  // E[n^2] / E[n] = (1 + p) / (1 - p): a third at p = 1/2
  EXPECT_NEAR(haptic_limit(device, 1000.0, 0.0, 0.5).grow_N_per_m, 4000.0 / 3.0, 1e-9);
  EXPECT_EQ(haptic_limit(device, 1000.0, 0.0, 0.0).grow_N_per_m,
            haptic_limit(device, 1000.0).grow_N_per_m);
}

TEST(HapticLimit, BadNumbersAllowNothing) {
  const double nan = std::nan("");
  for (const double bad : {nan, kInf, -1.0}) {
    EXPECT_EQ(haptic_limit(kDevice, bad).safe_N_per_m(), 0.0);
    DeviceAtTool d = kDevice;
    d.damping_Ns_per_m = bad;
    EXPECT_EQ(haptic_limit(d, 1000.0).safe_N_per_m(), 0.0);
    d = kDevice, d.delay_s = bad;
    EXPECT_EQ(haptic_limit(d, 1000.0).safe_N_per_m(), 0.0);
    d = kDevice, d.friction_N = bad;
    EXPECT_EQ(haptic_limit(d, 1000.0).safe_N_per_m(), 0.0);
    d = kDevice, d.position_step_m = bad;
    EXPECT_EQ(haptic_limit(d, 1000.0).safe_N_per_m(), 0.0);
  }
  EXPECT_EQ(haptic_limit(kDevice, 0.0).safe_N_per_m(), 0.0);
  EXPECT_EQ(haptic_limit(kDevice, 1000.0, nan).safe_N_per_m(), 0.0);
  EXPECT_EQ(haptic_limit(kDevice, 1000.0, 0.0, 1.0).safe_N_per_m(), 0.0);
  EXPECT_EQ(haptic_limit(kDevice, 1000.0, 0.0, nan).safe_N_per_m(), 0.0);
}

TEST(HapticLimit, HasConsistentDimensions) {
  const double m = 1e3, kg = 7.0, s = 0.3;
  const DeviceAtTool scaled{.damping_Ns_per_m = kDevice.damping_Ns_per_m * kg / s,
                            .friction_N = kDevice.friction_N * kg * m / (s * s),
                            .position_step_m = kDevice.position_step_m * m,
                            .delay_s = kDevice.delay_s * s};
  const HapticLimit a = haptic_limit(kDevice, 1000.0), b = haptic_limit(scaled, 1000.0 / s);
  EXPECT_NEAR(b.grow_N_per_m / a.grow_N_per_m, kg / (s * s), 1e-9);
  EXPECT_NEAR(b.quiet_N_per_m / a.quiet_N_per_m, kg / (s * s), 1e-9);
}

}  // namespace tact::model::law::haptic_limit_test
