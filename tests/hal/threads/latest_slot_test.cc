// SPDX-License-Identifier: Apache-2.0
#include "hal/threads/latest_slot.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "tests/support/no_alloc.h"

namespace tact::hal::threads::latest_slot_test {

TEST(LatestSlot, IsEmptyUntilTheFirstWrite) {
  LatestSlot<int> slot;
  int value = 7;
  EXPECT_FALSE(slot.read(value));
  EXPECT_EQ(value, 7);
}

TEST(LatestSlot, GivesTheNewestValueOnce) {
  LatestSlot<int> slot;
  int value = 0;
  for (int i = 1; i <= 5; ++i) slot.write(i);
  EXPECT_TRUE(slot.read(value));
  EXPECT_EQ(value, 5);
  EXPECT_FALSE(slot.read(value));
  slot.write(6);
  EXPECT_TRUE(slot.read(value));
  EXPECT_EQ(value, 6);
}

TEST(LatestSlot, NeverMixesTwoValuesNorGoesBack) {
  using Block = std::array<std::uint64_t, 64>;
  constexpr std::uint64_t kWrites = 200000;
  LatestSlot<Block> slot;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    Block block;
    for (std::uint64_t i = 1; i <= kWrites; ++i) {
      block.fill(i);
      slot.write(block);
    }
    done = true;
  });
  Block seen{};
  std::uint64_t last = 0, reads = 0, torn = 0, backwards = 0;
  for (bool finished = false; !finished;) {
    finished = done;  // one more read after the last write
    while (slot.read(seen)) {
      ++reads;
      for (const std::uint64_t word : seen) torn += word != seen[0];
      backwards += seen[0] <= last;
      last = seen[0];
    }
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_EQ(last, kWrites);
  EXPECT_GE(reads, 1u);
}

TEST(LatestSlot, LeavesTheHeapAlone) {
  LatestSlot<double> slot;
  double value = 0.0;
  tests::NoAlloc guard;
  slot.write(1.0);
  (void)slot.read(value);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::threads::latest_slot_test
