// SPDX-License-Identifier: Apache-2.0
#include "tools/program/sweep.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <set>

#include "tools/program/interrupt.h"

namespace tact::tools::program::sweep_test {

TEST(Sweep, EveryJobBelongsToExactlyOneShard) {
  for (const std::size_t jobs : {0u, 1u, 5u, 12u, 101u}) {
    for (const std::size_t count : {1u, 2u, 3u, 7u, 20u}) {
      std::multiset<std::size_t> seen;
      for (std::size_t index = 0; index < count; ++index) {
        const Shard shard{.index = index, .count = count};
        for (std::size_t k = 0; k < shard.jobs_of(jobs); ++k) {
          EXPECT_TRUE(shard.owns(shard.job(k)));
          seen.insert(shard.job(k));
        }
      }
      EXPECT_EQ(seen.size(), jobs);
      for (std::size_t job = 0; job < jobs; ++job) EXPECT_EQ(seen.count(job), 1u);
    }
  }
}

TEST(Sweep, ReadsShardsAndSaysWhatAShardIs) {
  const auto shard = parse_shard("2/5");
  ASSERT_TRUE(shard);
  EXPECT_EQ(shard->index, 2u);
  EXPECT_EQ(shard->count, 5u);
  EXPECT_TRUE(parse_shard("0/1")->is_whole());
  for (const char* bad :
       {"", "2", "5/5", "6/5", "0/0", "-1/4", "1/4x", "a/b", "1/", "/4", " 1/4"}) {
    const auto wrong = parse_shard(bad);
    ASSERT_FALSE(wrong) << bad;
    EXPECT_NE(wrong.error().sentence.find("0 <= i < n"), std::string::npos);
  }
}

TEST(Sweep, KeepsResultsInTheOrderOfJobsOnAnyNumberOfThreads) {
  for (const unsigned threads : {1u, 2u, 5u}) {
    const Shard shard{.index = 1, .count = 3};
    const auto results =
        sweep<std::size_t>(100, {.label = "test", .shard = shard, .threads = threads},
                           [](std::size_t job) { return 10 * job; });
    ASSERT_TRUE(results);
    ASSERT_EQ(results->size(), 33u);
    for (std::size_t k = 0; k < results->size(); ++k) EXPECT_EQ((*results)[k], 10 * (1 + 3 * k));
  }
}

TEST(Sweep, RunsEveryJobOnce) {
  std::vector<std::atomic<int>> ran(50);
  EXPECT_TRUE(run_jobs(50, {.label = "test", .threads = 4}, [&](std::size_t job) { ++ran[job]; }));
  for (const auto& times : ran) EXPECT_EQ(times.load(), 1);
}

TEST(Sweep, TellsTheFirstErrorAndBeginsNoJobAfterIt) {
  const auto run = [](std::size_t bad, std::size_t& begun) {
    return run_until_error(6, {.label = "", .shard = {}, .threads = 1},
                           [&](std::size_t job) -> std::optional<model::Error> {
                             ++begun;
                             if (job < bad) return std::nullopt;
                             return model::Error{"job " + std::to_string(job)};
                           });
  };
  std::size_t begun = 0;
  const auto error = run(2, begun);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->sentence, "job 2");
  EXPECT_EQ(begun, 3u);
  EXPECT_FALSE(run(6, begun));
}

TEST(Sweep, CtrlCEndsItBetweenTwoJobs) {
  const InterruptWatch watch;
  std::atomic<int> ran{0};
  const auto results = sweep<int>(1000, {.label = "test", .threads = 2}, [&](std::size_t) {
    if (++ran == 10) std::raise(SIGINT);
    return 1;
  });
  EXPECT_FALSE(results);
  EXPECT_GE(ran.load(), 10);
  EXPECT_LT(ran.load(), 1000);
  EXPECT_TRUE(is_interrupted());
}

TEST(Sweep, AnotherWatchStartsWithoutTheOldCtrlC) {
  {
    const InterruptWatch watch;
    std::raise(SIGTERM);
    EXPECT_TRUE(is_interrupted());
  }
  const InterruptWatch watch;
  EXPECT_FALSE(is_interrupted());
}

}  // namespace tact::tools::program::sweep_test
