// SPDX-License-Identifier: Apache-2.0
// A start on CiA 402 drives as another host, or an earlier run, has left them.
#include <gtest/gtest.h>

#include "tests/hal/emulated/cia402_emulated_bench.h"

namespace tact::hal::emulated::cia402_other_hosts_test {

using Bench = Cia402Bench;

TEST(Cia402OtherHosts, AnErrorThatIsLeftFromAnEarlierHostNeedsNoPowerCycle) {
  // Its guarding ended with it, or it stopped to send SYNC.
  Bench guarded({.guard_time_ms = 100, .life_time_factor = 3, .errors_bar_operational = true});
  guarded.guard();
  for (int i = 0; i < 400; ++i) guarded.drives.millisecond();
  EXPECT_EQ(guarded.drives.at(0).noted(), std::vector<std::uint16_t>{0x8130});
  ASSERT_TRUE(guarded.run());
  guarded.expect_torques_of({0.0, 0.0, 4.0});

  Bench synchronised({.sync_period_us = 4000, .errors_bar_operational = true});
  for (int run = 0; run < 3; ++run) {
    ASSERT_TRUE(synchronised.run());
    synchronised.expect_torques_of({0.0, 0.0, 4.0});
    synchronised.device->stop();
    for (int i = 0; i < 200; ++i) synchronised.drives.millisecond();
    EXPECT_EQ(synchronised.drives.at(0).noted().back(), 0x8100);
    synchronised.drives.connect_again();
  }
}

TEST(Cia402OtherHosts, SyncIsWhatEachDriveExpectsAfterAnySettingsOfAnotherHost) {
  for (const int period_us : {0, 500, 10'000}) {
    for (const int counter : {0, 10}) {
      Bench bench({.sync_period_us = period_us, .sync_counter = counter});
      ASSERT_TRUE(bench.run());
      bench.expect_no_fault_for(300);
      bench.expect_torques_of({1.0, -2.0, 3.0});
      EXPECT_FALSE(bench.drives.any_noted()) << period_us << " us, " << counter;
    }
  }
}

TEST(Cia402OtherHosts, SyncHasItsIdentifierAfterAnySettingsOfAnotherHost) {
  Bench bench({.sync_id = 0x90});
  ASSERT_TRUE(bench.run());
  bench.expect_torques_of({1.0, -2.0, 3.0});
}

TEST(Cia402OtherHosts, AWatchOverOurNodeUnderAnotherSubIndexIsSwitchedOff) {
  constexpr std::uint32_t kOurs = 127u << 16 | 100u, kAnothers = 126u << 16 | 100u;
  for (const std::uint32_t stored : {kOurs, kAnothers}) {
    Bench bench({.second_watch = stored});
    ASSERT_TRUE(bench.run());
    bench.expect_torques_of({1.0, -2.0, 3.0});
  }
}

}  // namespace tact::hal::emulated::cia402_other_hosts_test
