// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace tact::firmware::loop::latency_histogram_test {

TEST(LatencyHistogram, IsExactBelow64Nanoseconds) {
  LatencyHistogram h;
  for (int i = 0; i < 64; ++i) h.record(i, 0);
  EXPECT_EQ(h.percentile_ns(0.5), 31u);
  EXPECT_EQ(h.percentile_ns(1.0), 63u);
}

TEST(LatencyHistogram, PercentilesAreWithinOneSixtyFourthOfTheTruth) {
  std::mt19937 random(2);
  std::lognormal_distribution<double> latency(8.0, 2.0);
  auto h = std::make_unique<LatencyHistogram>();
  std::vector<std::int64_t> all;
  for (int i = 0; i < 100000; ++i) {
    all.push_back(std::llround(latency(random)));
    h->record(all.back(), static_cast<std::uint64_t>(i));
  }
  std::sort(all.begin(), all.end());
  for (const double share : {0.5, 0.9, 0.99, 0.999, 0.9999}) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * 100000.0)) - 1;
    const auto truth = static_cast<double>(all[rank]);
    EXPECT_GE(static_cast<double>(h->percentile_ns(share)), truth);
    EXPECT_LE(static_cast<double>(h->percentile_ns(share)), truth * (1.0 + 1.0 / 64.0) + 1.0);
  }
}

TEST(LatencyHistogram, KeepsTheMaximumWithItsTick) {
  LatencyHistogram h;
  h.record(10, 1);
  h.record(123456789, 2);
  h.record(20, 3);
  EXPECT_EQ(h.max_ns(), 123456789u);
  EXPECT_EQ(h.max_tick(), 2u);
  EXPECT_EQ(h.percentile_ns(1.0), 123456789u);
}

TEST(LatencyHistogram, TakesNegativeAndHugeDurations) {
  LatencyHistogram h;
  h.record(-5, 0);
  h.record(INT64_MAX, 1);
  EXPECT_EQ(h.count(), 2u);
  EXPECT_EQ(h.percentile_ns(0.5), 0u);
  EXPECT_EQ(h.max_ns(), static_cast<std::uint64_t>(INT64_MAX));
}

TEST(LatencyHistogram, IsEmptyAtFirst) { EXPECT_EQ(LatencyHistogram().percentile_ns(0.5), 0u); }

}  // namespace tact::firmware::loop::latency_histogram_test
