// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/operator_signals.h"

#include <gtest/gtest.h>

#include <chrono>
#include <utility>
#include <vector>

namespace tact::firmware::run::operator_signals_test {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class Operator : public testing::Test {
 protected:
  void ask(int signal) {
    raise(signal);
    signals.obey(requests, kSecond_ns);
  }
  loop::Requests requests;
  std::vector<std::pair<bool, bool>> reads;  // arm and reset, whenever the loop had time to read
  OperatorSignals signals{
      [this] { reads.emplace_back(requests.arm.load(), requests.reset.load()); }};
};

TEST_F(Operator, EveryWayToEndAsksForZeroForceFirst) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    requests.stop.store(false);
    ask(signal);
    EXPECT_TRUE(requests.stop.load()) << signal;
  }
}

TEST_F(Operator, ResetDisarmsBeforeItsEdgeAndNeverArms) {
  requests.arm.store(true);
  ask(SIGUSR1);
  ASSERT_EQ(reads.size(), 2u);
  EXPECT_EQ(reads[0], std::pair(false, false)) << "disarmed, and no edge yet";
  EXPECT_EQ(reads[1], std::pair(false, true)) << "the edge";
  EXPECT_FALSE(requests.arm.load());
  EXPECT_FALSE(requests.reset.load()) << "a level that stood would hide the next edge";
  EXPECT_FALSE(requests.stop.load());
}

TEST(OperatorSignals, TheSlowestLoopHasTwoTicksToReadEachLevel) {
  const auto begun = std::chrono::steady_clock::now();
  wait_several_ticks();
  EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(2 * 10));
}

TEST_F(Operator, ArmIsARequestOfItsOwn) {
  ask(SIGUSR2);
  EXPECT_TRUE(requests.arm.load());
  EXPECT_FALSE(requests.reset.load());
}

TEST_F(Operator, WithoutASignalNothingChanges) {
  signals.obey(requests, 0);
  EXPECT_FALSE(requests.arm.load() || requests.stop.load() || requests.reset.load());
}

}  // namespace tact::firmware::run::operator_signals_test
