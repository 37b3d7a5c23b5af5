// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hal/falcon/falcon_device.h"

namespace tact::hal::falcon::falcon_exchange_test {

constexpr std::int64_t kMs = 1'000'000;

TEST(FalconExchange, EachCommandIsAnsweredOnce) {
  FalconExchange exchange;
  EXPECT_EQ(exchange.answered(1, 0), 0u);  // not requested
  exchange.sent(0);
  exchange.sent(1 * kMs);
  EXPECT_EQ(exchange.answered(1, 2 * kMs), 1u);
  EXPECT_EQ(exchange.answered(5, 2 * kMs), 1u);
  EXPECT_EQ(exchange.answered(1, 2 * kMs), 0u);
}

TEST(FalconExchange, AnOldCommandIsNotWaitedFor) {
  FalconExchange exchange;
  exchange.sent(0);
  exchange.sent(3 * kMs);
  EXPECT_EQ(exchange.answered(2, 9 * kMs), 1u);
  exchange.sent(10 * kMs);
  EXPECT_EQ(exchange.answered(1, 18 * kMs), 1u);  // exactly as old as it may be
}

TEST(FalconExchange, SendsAheadOfThreeAnswersOnlyWhenTheOldestIsLate) {
  FalconExchange exchange;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(exchange.may_send(0));
    exchange.sent(0);
  }
  EXPECT_FALSE(exchange.may_send(2 * kMs - 1));
  EXPECT_TRUE(exchange.may_send(2 * kMs));
}

TEST(FalconExchange, ALongSilenceForgetsTheOldestFirst) {
  FalconExchange exchange;
  for (int i = 0; i < 100; ++i) exchange.sent(i * kMs);
  EXPECT_EQ(exchange.answered(100, 100 * kMs), 8u);  // those of 92 to 99 ms
}

}  // namespace tact::hal::falcon::falcon_exchange_test
