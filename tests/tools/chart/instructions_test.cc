// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/measure/instructions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tact::tools::chart::instructions_test {

/// n turns of two instructions each, for any compiler.
void turn(std::size_t turns) { asm volatile("1: dec %0\n jnz 1b" : "+r"(turns) : : "cc"); }

TEST(Instructions, LoopCountsTwoInstructionsPerTurn) {
  const double short_loop = instructions_by_steps([] { turn(100); }, 5);
  const double long_loop = instructions_by_steps([] { turn(600); }, 5);
  EXPECT_EQ(long_loop - short_loop, 1000.0);
  EXPECT_GE(short_loop, 200.0);
  EXPECT_LT(short_loop, 350.0);  // the call through std::function, unoptimized
}

TEST(Instructions, AreTheMeanOfTheCallsThatWereCounted) {
  std::size_t call = 0;
  const double mean = instructions_by_steps([&call] { turn(call++ % 2 == 0 ? 100 : 300); }, 8);
  EXPECT_GT(mean, 400.0);
  EXPECT_LT(mean, 550.0);
  EXPECT_EQ(call, 0U) << "stepped in a copy: nothing of this process moves";
}

TEST(Instructions, CountOfATooLongCallIsNan) {
  EXPECT_TRUE(std::isnan(instructions_by_steps([] { turn(1000); }, 2, 1500)));
}

TEST(Instructions, ByEitherWayAreOfTheSameSize) {
  const double either = instructions_per_call([] { turn(5000); }, 4);
  EXPECT_NEAR(either, 10000.0, 200.0);
}

}  // namespace tact::tools::chart::instructions_test
