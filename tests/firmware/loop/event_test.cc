// SPDX-License-Identifier: Apache-2.0
// Events and the sync line: in the record of their tick.
#include <gtest/gtest.h>

#include "model/time_ns.h"
#include "tests/support/puppet_loop.h"

namespace tact::firmware::loop::event_test {

using EventTest = PuppetLoop;

TEST_F(EventTest, AnEventAndTheEventLinesAreInTheRecordOfTheNextTick) {
  run_ticks(3);
  EXPECT_EQ(newest().event, 0);
  requests.event.store(200);
  lines.event_bits = 0x81;
  loop.step();
  TickRecord record = newest();
  EXPECT_EQ(record.event, 200);
  EXPECT_EQ(record.event_word, 0x81);
  EXPECT_EQ(requests.event.load(), (record.tick + 1) << 8) << "the answer names the tick";
  loop.step();
  record = newest();
  EXPECT_EQ(record.event, 0) << "one tick alone";
  EXPECT_EQ(record.event_word, 0x81);
}

TEST_F(EventTest, TheSyncLineIsHighInOddSecondsOfTheClock) {
  for (int second = 0; second < 4; ++second) {
    while (clock.now_ns() < second * model::kSecond_ns + model::kSecond_ns / 2) loop.step();
    EXPECT_EQ(lines.last.sync, second % 2 != 0) << second;
    EXPECT_EQ(newest().sync, lines.last.sync) << second;
  }
}

}  // namespace tact::firmware::loop::event_test
