// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/overrun_counter.h"

#include <gtest/gtest.h>

namespace tact::firmware::loop::late_watch_test {

TEST(OverrunCounter, StopsAtTwentyLateTicksInARowOrAHundredWithoutHardRealTime) {
  for (const bool hard : {true, false}) {
    OverrunCounter watch(hard);
    int late = 1;
    while (!watch.step(1)) ++late;
    EXPECT_EQ(late, hard ? 20 : 100);
  }
}

TEST(OverrunCounter, GoesOnSayingStopAndForgetsItInOneTickThatIsInTime) {
  OverrunCounter watch(false);
  for (int i = 0; i < 99; ++i) ASSERT_FALSE(watch.step(1)) << i;
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(watch.step(1)) << i;
  EXPECT_FALSE(watch.step(0));
  EXPECT_FALSE(watch.step(1));
}

TEST(OverrunCounter, WithHardRealTimeTwentyPeriodsSkippedAtOnceStopToo) {
  EXPECT_TRUE(OverrunCounter(true).step(20));
  EXPECT_FALSE(OverrunCounter(true).step(19));
  EXPECT_FALSE(OverrunCounter(false).step(1000));
}

}  // namespace tact::firmware::loop::late_watch_test
