// SPDX-License-Identifier: Apache-2.0
// Where deadlines lie, and what other threads and the kernel's tick keep away from them.
#include "firmware/loop/release_schedule.h"

#include <gtest/gtest.h>

namespace tact::firmware::loop::release_schedule_test {

constexpr std::int64_t kPeriods_ns[] = {250'000, 500'000, 1'000'000, 2'000'000, 4'000'000};
constexpr std::int64_t kStarts_ns[] = {0,         1,          299'999,           300'000,
                                       1'000'000, 12'345'678, 86'400'000'000'001};

TEST(ReleaseSchedule, IsTheSameWheneverTheLoopStarts) {
  for (const std::int64_t period_ns : kPeriods_ns)
    for (const std::int64_t start_ns : kStarts_ns) {
      const std::int64_t first_ns = next_deadline_ns(start_ns, period_ns);
      EXPECT_GE(first_ns, start_ns);
      EXPECT_LT(first_ns, start_ns + period_ns) << "and none is left out";
      EXPECT_EQ(first_ns % period_ns, next_deadline_ns(0, period_ns));
      EXPECT_EQ(next_deadline_ns(first_ns, period_ns), first_ns) << "a deadline is one";
      EXPECT_EQ(next_deadline_ns(first_ns + 1, period_ns), first_ns + period_ns);
    }
}

// A tick of a kernel with HZ = 100, 250 or 1000 comes at whole milliseconds, if at all.
TEST(ReleaseSchedule, WakesFarFromTheKernelsTick) {
  for (const std::int64_t period_ns : kPeriods_ns)
    for (std::int64_t due_ns = next_deadline_ns(0, period_ns); due_ns < 20'000'000;
         due_ns += period_ns) {
      const std::int64_t after_tick_ns = due_ns % 1'000'000;
      EXPECT_GE(after_tick_ns, 75'000) << "the kernel's work for it is done";
      EXPECT_GE(1'000'000 - after_tick_ns, std::min<std::int64_t>(period_ns, 1'000'000) * 6 / 10);
    }
}

TEST(ReleaseSchedule, OtherThreadsWakeHalfAPeriodAwayFromEveryDeadline) {
  for (const std::int64_t period_ns : kPeriods_ns)
    for (const std::int64_t start_ns : kStarts_ns) {
      const std::int64_t wake_ns = next_half_way_ns(start_ns, period_ns);
      EXPECT_GE(wake_ns, start_ns);
      EXPECT_LT(wake_ns, start_ns + period_ns);
      EXPECT_EQ(next_deadline_ns(wake_ns, period_ns) - wake_ns, period_ns / 2);
    }
}

TEST(ReleaseSchedule, ADeadlineIsMissedFromItsOwnInstantOn) {
  EXPECT_EQ(periods_missed(5'000, 4'999, 1'000), 0);
  EXPECT_EQ(periods_missed(5'000, 5'000, 1'000), 1);
  EXPECT_EQ(periods_missed(5'000, 5'999, 1'000), 1);
  EXPECT_EQ(periods_missed(5'000, 7'500, 1'000), 3);
}

}  // namespace tact::firmware::loop::release_schedule_test
