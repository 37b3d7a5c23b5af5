// SPDX-License-Identifier: Apache-2.0
// Arming is an act, made once, when it may be.
#include "firmware/console/operator_desk.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/firmware/console/desk_surroundings.h"

namespace tact::firmware::console::operator_desk_test {

using loop::State;

class Desk : public DeskSurroundings {
 protected:
  std::string ask(int signal) {
    raise(signal);
    return told([&] { desk.obey(1'000'000'000); });
  }
  std::string show(State state) {
    frame.state = state;
    return told([&] { desk.obey(0); });
  }
  template <typename Does>
  static std::string told(Does does) {
    testing::internal::CaptureStderr();
    does();
    return testing::internal::GetCapturedStderr();
  }

  OperatorDesk desk{signals, requests, view, [this] { return frame; }, nullptr, tick};
};

TEST_F(Desk, ArmsOnlyAfterTheWordsThatItMayBe) {
  EXPECT_NE(ask(SIGUSR2).find("not armed: the device is not ready yet"), std::string::npos);
  show(State::kOff);
  EXPECT_NE(ask(SIGUSR2).find("not armed"), std::string::npos);
  EXPECT_TRUE(edges.empty());
  EXPECT_EQ(requests.refused.load(), 2u);
  EXPECT_NE(show(State::kReady).find("ready, force is off"), std::string::npos);
  EXPECT_EQ(ask(SIGUSR2), "");
  EXPECT_EQ(edges, (std::vector<std::string>{"arm"}));
  EXPECT_EQ(requests.refused.load(), 2u);
}

TEST_F(Desk, ARequestThatWaitsWhileTheWordsAreToldIsRefused) {
  raise(SIGUSR2);
  raise(SIGUSR1);
  EXPECT_NE(show(State::kReady).find("came before it was ready"), std::string::npos);
  desk.obey(0);
  desk.obey(0);
  EXPECT_TRUE(edges.empty()) << "queued";
  EXPECT_EQ(requests.refused.load(), 2u);
}

TEST_F(Desk, ResetsAStopAloneAndTheWordsComeAgainBeforeTheNextArming) {
  show(State::kReady);
  EXPECT_NE(ask(SIGUSR1).find("not reset: it is ready, not stopped"), std::string::npos);
  show(State::kArmed);
  EXPECT_NE(ask(SIGUSR2).find("armed already"), std::string::npos);
  show(State::kStopped);
  EXPECT_NE(ask(SIGUSR2).find("reset it first"), std::string::npos);
  EXPECT_TRUE(edges.empty());
  EXPECT_EQ(ask(SIGUSR1), "");
  EXPECT_EQ(edges, (std::vector<std::string>{"reset"}));
  EXPECT_NE(ask(SIGUSR2).find("not armed"), std::string::npos) << "the words were not told yet";
  EXPECT_NE(show(State::kReady).find("ready, force is off"), std::string::npos);
  EXPECT_EQ(ask(SIGUSR2), "");
  EXPECT_EQ(edges.back(), "arm");
}

TEST_F(Desk, WhatTheLoopRefusesIsTold) {
  refuses = true;
  show(State::kReady);
  EXPECT_NE(ask(SIGUSR2).find("not armed: no power"), std::string::npos);
  EXPECT_EQ(pauses, 1) << "the echo ends the wait";
}

TEST_F(Desk, ALoopThatDoesNotAnswerIsNotAskedLater) {
  stands = true;
  show(State::kReady);
  EXPECT_NE(ask(SIGUSR2).find("not armed: the loop gives no answer"), std::string::npos);
  EXPECT_EQ(requests.asked.load() & 3U, 0U) << "taken back";
}

TEST_F(Desk, ARequestThatWasDoneBeforeItWasTakenBackIsToldAsDone) {
  std::uint32_t taken = 0;  // by a tick that ends after the desk has given up
  OperatorDesk other(
      signals, requests, view, [this] { return frame; }, nullptr,
      [&] {
        const std::uint32_t asked = requests.asked.load();
        if ((asked & 3U) != 0) taken = asked;
        if ((asked & 3U) == 0) requests.echo(taken, true);
      });
  show(State::kReady);
  raise(SIGUSR2);
  EXPECT_EQ(told([&] { other.obey(1'000'000'000); }), "");
  EXPECT_EQ(requests.asked.load() & 3U, 0U);
}

TEST_F(Desk, ALoopThatHangsHoldsTheMainThreadForLessThanHalfASecond) {
  stands = true;
  show(State::kReady);
  ask(SIGUSR2);
  EXPECT_LT(pauses, 500) << "of 1 ms; five requests in a row stay below WatchdogSec";
}

TEST_F(Desk, ADeviceThatArmsItselfAtTheStartWaitsForAPersonAfterAStop) {
  OperatorView itself(device, lines, true);
  OperatorDesk other(signals, requests, itself, [this] { return frame; }, nullptr, tick);
  for (const State state : {State::kReady, State::kArmed, State::kStopped, State::kReady}) {
    frame.state = state;
    const std::string words = told([&] { other.obey(0); });
    EXPECT_EQ(words.find("ready, force is off") != std::string::npos,
              state == State::kReady && !itself.why_not_arm().starts_with("it arms itself"))
        << words;
  }
  EXPECT_EQ(itself.why_not_arm(), "");
}

}  // namespace tact::firmware::console::operator_desk_test
