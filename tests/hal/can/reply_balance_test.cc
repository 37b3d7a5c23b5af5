// SPDX-License-Identifier: Apache-2.0
#include "hal/can/reply_balance.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/extent.h"

namespace tact::hal::can::reply_balance_test {

/// A drive that answers each request once: in its tick, a tick late, or not at all. Reads may be
/// cut short, periods skipped.
class Drive {
 public:
  explicit Drive(std::uint32_t seed) : random_(seed) {}
  /// Of `drives` with one node id. Returns the requests of this tick.
  int tick(ReplyBalance& balance, int drives, int requests) {
    const bool complete = !any(0.02);
    int replies = late_;
    late_ = 0;
    for (int i = 0; i < drives * requests; ++i) {
      if (any(0.05)) continue;  // lost
      if (any(0.05) || !complete)
        ++late_;
      else
        ++replies;
    }
    for (int i = 0; i < replies; ++i) balance.add_reply();
    balance.step(requests, complete);
    return any(0.05) ? 0 : 1;
  }

 private:
  bool any(double share) { return std::bernoulli_distribution(share)(random_); }
  std::mt19937 random_;
  int late_ = 0;
};

TEST(ReplyBalance, OneDriveNeverExceedsItOnAnyPath) {
  for (std::uint32_t seed = 0; seed < tests::share_of(200, 20'000); ++seed) {
    Drive drive(seed);
    ReplyBalance balance;
    int requests = 0;
    for (int tick = 0; tick < 2000; ++tick) {
      requests = drive.tick(balance, 1, requests);
      ASSERT_FALSE(balance.is_exceeded()) << "seed " << seed << ", tick " << tick;
    }
  }
}

TEST(ReplyBalance, TwoDrivesExceedItInThreeTicks) {
  ReplyBalance balance;
  balance.step(1, true);  // a reply was lost
  for (int tick = 0; tick < 3; ++tick) {
    ASSERT_FALSE(balance.is_exceeded());
    balance.add_reply(), balance.add_reply();
    balance.step(1, true);
  }
  EXPECT_TRUE(balance.is_exceeded());
}

TEST(ReplyBalance, TwoDrivesExceedItOnAnyPath) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Drive drives(seed);
    ReplyBalance balance;
    int requests = 0, ticks = 0;
    while (!balance.is_exceeded() && ticks < 2000) {
      requests = drives.tick(balance, 2, requests);
      ++ticks;
    }
    EXPECT_LT(ticks, 2000) << "seed " << seed;
  }
}

}  // namespace tact::hal::can::reply_balance_test
