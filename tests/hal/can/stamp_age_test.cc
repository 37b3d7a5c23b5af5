// SPDX-License-Identifier: Apache-2.0
#include "hal/can/stamp_age.h"

#include <gtest/gtest.h>

namespace tact::hal::can::stamp_age_test {

constexpr std::int64_t kMs = 1'000'000, kYear = 31'536'000'000 * kMs;

/// A queue that is looked into every millisecond, and a wall clock that a person sets.
struct Clocks {
  std::int64_t monotonic_ns = 5'000 * kMs;
  std::int64_t wall_ns = 50 * kYear;
  StampAge stamps;

  Clocks() { look(true); }
  void pass(std::int64_t time_ns) { monotonic_ns += time_ns, wall_ns += time_ns; }
  void look(bool empties) { stamps.look(wall_ns, monotonic_ns, empties); }
};

TEST(StampAge, IsTheTimeSinceTheStampWhileTheClockIsNotSet) {
  Clocks clocks;
  const std::int64_t stamp_ns = clocks.wall_ns + kMs / 4;
  clocks.pass(kMs);
  clocks.look(false);
  EXPECT_EQ(clocks.stamps.of(stamp_ns), 3 * kMs / 4);
  EXPECT_EQ(clocks.stamps.of(clocks.wall_ns + 1), 0) << "a stamp of the future is fresh";
}

TEST(StampAge, AgeIsExactBeforeAndAfterAClockStep) {
  for (const std::int64_t step_ns : {7 * kYear, -7 * kYear, 40 * kMs, -40 * kMs}) {
    Clocks clocks;
    clocks.pass(kMs / 4);
    const std::int64_t before_ns = clocks.wall_ns;
    clocks.pass(kMs / 4);
    clocks.wall_ns += step_ns;
    const std::int64_t after_ns = clocks.wall_ns;
    clocks.pass(kMs / 2);
    clocks.look(true);
    EXPECT_EQ(clocks.stamps.of(before_ns), 3 * kMs / 4) << step_ns;
    EXPECT_EQ(clocks.stamps.of(after_ns), kMs / 2) << step_ns;

    const std::int64_t next_ns = clocks.wall_ns + kMs / 2;
    clocks.pass(kMs);
    clocks.look(true);
    EXPECT_EQ(clocks.stamps.of(next_ns), kMs / 2) << "the tick after a step of " << step_ns;
  }
}

TEST(StampAge, AnOldFrameIsNeverFreshBesideAStep) {
  // The loop stood for 30 ms; the clock went back by as much as the frame is old, or nearly.
  for (const std::int64_t back_ns : {29 * kMs, 30 * kMs, 20 * kMs, kMs / 2}) {
    Clocks clocks;
    const std::int64_t stamp_ns = clocks.wall_ns;
    clocks.pass(30 * kMs);
    clocks.wall_ns -= back_ns;
    clocks.look(true);
    EXPECT_EQ(clocks.stamps.of(stamp_ns), 30 * kMs) << back_ns;
  }
}

TEST(StampAge, FramesLeftByAFullReadKeepTheClockOfTheirTime) {
  Clocks clocks;
  clocks.pass(20 * kMs);
  const std::int64_t stamp_ns = clocks.wall_ns;
  clocks.pass(5 * kMs);
  clocks.wall_ns -= kYear;
  clocks.look(false);  // 64 frames came, and there may be more
  clocks.pass(kMs);
  clocks.look(true);
  EXPECT_EQ(clocks.stamps.of(stamp_ns), 6 * kMs);
}

}  // namespace tact::hal::can::stamp_age_test
