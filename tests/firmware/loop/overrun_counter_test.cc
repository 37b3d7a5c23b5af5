// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/overrun_counter.h"

#include <gtest/gtest.h>

namespace tact::firmware::loop::late_watch_test {

TEST(OverrunCounter, StopsAtTwentyLateTicksInARowOrAHundredWithoutHardRealTime) {
  for (const bool hard : {true, false}) {
    OverrunCounter watch(hard, 1e-3);
    int late = 1;
    while (!watch.step(1)) ++late;
    EXPECT_EQ(late, hard ? 20 : 100);
  }
}

TEST(OverrunCounter, GoesOnSayingStopAndForgetsItInOneTickThatIsInTime) {
  OverrunCounter watch(false, 1e-3);
  for (int i = 0; i < 99; ++i) ASSERT_FALSE(watch.step(1)) << i;
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(watch.step(1)) << i;
  EXPECT_FALSE(watch.step(0));
  EXPECT_FALSE(watch.step(1));
}

TEST(OverrunCounter, WithHardRealTimeTwentyPeriodsSkippedAtOnceStopToo) {
  EXPECT_TRUE(OverrunCounter(true, 1e-3).step(20));
  EXPECT_FALSE(OverrunCounter(true, 1e-3).step(19));
}

// SIGSTOP and SIGCONT, or a debugger: the position of the hand is unknown.
TEST(OverrunCounter, APauseOfAThirdOfASecondStopsOnAnyKernel) {
  EXPECT_FALSE(OverrunCounter(false, 1e-3).step(299));
  EXPECT_TRUE(OverrunCounter(false, 1e-3).step(300)) << "0.3 s, at any rate";
  EXPECT_TRUE(OverrunCounter(false, 1e-4).step(3000));
  EXPECT_FALSE(OverrunCounter(false, 1e-4).step(2999));
}

}  // namespace tact::firmware::loop::late_watch_test
