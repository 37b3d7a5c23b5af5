// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/operator_signals.h"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

namespace tact::firmware::run::operator_signals_test {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(OperatorSignals, EveryWayToEndAsksToLeave) {
  const OperatorSignals signals;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    raise(signal);
    EXPECT_EQ(signals.wait(kSecond_ns), Act::kLeave) << signal;
  }
}

TEST(OperatorSignals, ResetAndArmAreRequestsOfTheirOwn) {
  const OperatorSignals signals;
  raise(SIGUSR1);
  EXPECT_EQ(signals.wait(kSecond_ns), Act::kReset);
  raise(SIGUSR2);
  EXPECT_EQ(signals.wait(kSecond_ns), Act::kArm);
  EXPECT_EQ(signals.wait(0), Act::kNone);
}

TEST(OperatorSignals, AnEdgeFallsAgainBeforeAnybodyAsksForTheNext) {
  std::atomic<bool> request{false};
  std::vector<bool> reads;
  const OperatorSignals signals([&] { reads.push_back(request.load()); });
  signals.raise_edge(request);
  EXPECT_EQ(reads, (std::vector<bool>{true, false})) << "the loop had time to read each";
}

TEST(OperatorSignals, TheSlowestLoopHasTwoTicksToReadEachLevel) {
  const auto begun = std::chrono::steady_clock::now();
  wait_several_ticks();
  EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(2 * 10));
}

// In a process of its own, as the dispositions stay.
TEST(OperatorSignals, NothingThatComesBeforeTheLoopOrByMistakeEndsTheProcess) {
  const auto outlive = [] {
    outlive_stray_signals();
    for (const int signal : {SIGUSR1, SIGUSR2, SIGXFSZ, SIGALRM, SIGIO, SIGPROF, SIGVTALRM, SIGPWR,
                             SIGPIPE, SIGRTMIN, SIGRTMAX})
      raise(signal);
    const OperatorSignals signals;
    _exit(signals.forget() == 2 && signals.wait(0) == Act::kNone ? 7 : 8);
  };
  EXPECT_EXIT(outlive(), testing::ExitedWithCode(7), "");
}

}  // namespace tact::firmware::run::operator_signals_test
