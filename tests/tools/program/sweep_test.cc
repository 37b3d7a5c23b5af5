// SPDX-License-Identifier: Apache-2.0
#include "tools/program/sweep.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include "tools/program/interrupt.h"

namespace tact::tools::program::sweep_test {

TEST(Sweep, KeepsResultsInTheOrderOfJobsOnAnyNumberOfThreads) {
  for (const unsigned threads : {1u, 2u, 5u}) {
    const auto results = sweep<std::size_t>(100, {.label = "test", .threads = threads},
                                            [](std::size_t job) { return 10 * job; });
    ASSERT_TRUE(results);
    ASSERT_EQ(results->size(), 100u);
    for (std::size_t job = 0; job < results->size(); ++job) EXPECT_EQ((*results)[job], 10 * job);
  }
}

TEST(Sweep, RunsEveryJobOnce) {
  std::vector<std::atomic<int>> ran(50);
  EXPECT_TRUE(run_jobs(50, {.label = "test", .threads = 4}, [&](std::size_t job) { ++ran[job]; }));
  for (const auto& times : ran) EXPECT_EQ(times.load(), 1);
}

TEST(Sweep, CtrlCEndsItBetweenTwoJobs) {
  const InterruptFlag watch;
  std::atomic<int> ran{0};
  const auto results = sweep<int>(1000, {.label = "test", .threads = 2}, [&](std::size_t) {
    if (++ran == 10) kill(getpid(), SIGINT);  // as a terminal: a worker takes no signal
    for (int ms = 0; ran >= 10 && ms < 1000 && !is_interrupted(); ++ms)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return 1;
  });
  EXPECT_FALSE(results);
  EXPECT_GE(ran.load(), 10);
  EXPECT_LT(ran.load(), 1000);
  EXPECT_TRUE(is_interrupted());
}

TEST(Sweep, AnotherWatchStartsWithoutTheOldCtrlC) {
  {
    const InterruptFlag watch;
    std::raise(SIGTERM);
    EXPECT_TRUE(is_interrupted());
  }
  const InterruptFlag watch;
  EXPECT_FALSE(is_interrupted());
}

}  // namespace tact::tools::program::sweep_test
