// SPDX-License-Identifier: Apache-2.0
#include "hal/can/sample_gap.h"

#include <gtest/gtest.h>

#include <random>

namespace tact::hal::can::sample_gap_test {

constexpr std::int64_t kPeriod_ns = 1'000'000;

TEST(SampleGap, OneMissingSampleIsNormal) {
  SampleGap gap(1000.0);
  for (int i = 0; i < 100; ++i) {
    gap.step(i % 2 == 0, kPeriod_ns);
    EXPECT_EQ(gap.torque_ratio(), 1.0);
  }
}

TEST(SampleGap, RampsDownFromTheSecondInTenMillisecondsAndUpAgain) {
  SampleGap gap(1000.0);
  for (int i = 0; i <= 10; ++i) {
    EXPECT_NEAR(gap.torque_ratio(), i == 0 ? 1.0 : 1.0 - 0.1 * (i - 1), 1e-12) << i;
    gap.step(false, kPeriod_ns);
  }
  EXPECT_EQ(gap.torque_ratio(), 0.0);
  for (int i = 1; i <= 10; ++i) {
    gap.step(true, kPeriod_ns);
    EXPECT_NEAR(gap.torque_ratio(), 0.1 * i, 1e-12);
  }
}

TEST(SampleGap, TwentyMissingAreALostDevice) {
  SampleGap gap(1000.0);
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(gap.is_lost()) << i;
    gap.step(false, kPeriod_ns);
  }
  EXPECT_TRUE(gap.is_lost());
  gap.step(true, kPeriod_ns);
  EXPECT_FALSE(gap.is_lost());
}

// RT-15 is a time: a loop that skips periods has zero torque no later than one that does not.
TEST(SampleGap, SkippedPeriodsCountAsTime) {
  std::mt19937 random(1);
  for (const double rate_Hz : {100.0, 1000.0, 10000.0}) {
    for (int run = 0; run < 100; ++run) {
      SampleGap gap(rate_Hz);
      gap.step(false, 0);
      const auto period_ns = static_cast<std::int64_t>(1e9 / rate_Hz);
      double since_s = 0.0;
      while (since_s < 0.010 - 1e-9) {
        const std::int64_t periods = std::uniform_int_distribution<std::int64_t>(1, 4)(random);
        gap.step(false, periods * period_ns + period_ns / 4);  // late by less than a half
        since_s += static_cast<double>(periods) / rate_Hz;
      }
      EXPECT_EQ(gap.torque_ratio(), 0.0) << rate_Hz;
    }
  }
}

}  // namespace tact::hal::can::sample_gap_test
