#include "firmware/operator_signals.h"

#include <gtest/gtest.h>

#include <thread>

namespace tact::firmware {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class Operator : public testing::Test {
 protected:
  void ask(int signal) {
    raise(signal);
    signals.obey(requests, kSecond_ns);
  }
  OperatorSignals signals;
  Requests requests;
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
  bool edge = false, edge_while_armed = false;
  std::atomic<bool> over{false};
  std::thread loop([&] {
    while (!over.load()) {
      // the order in which the loop reads them
      const bool arm = requests.arm.load(), reset = requests.reset.load();
      edge = edge || reset;
      edge_while_armed = edge_while_armed || (reset && arm);
    }
  });
  ask(SIGUSR1);
  over.store(true);
  loop.join();
  EXPECT_TRUE(edge);
  EXPECT_FALSE(edge_while_armed);
  EXPECT_FALSE(requests.arm.load());
  EXPECT_FALSE(requests.reset.load()) << "a level that stood would hide the next edge";
  EXPECT_FALSE(requests.stop.load());
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

}  // namespace
}  // namespace tact::firmware
