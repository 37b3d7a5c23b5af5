// SPDX-License-Identifier: Apache-2.0
// The operator's desk asked by its socket: the same rule as by signals, and a sentence back.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <vector>

#include "firmware/console/control_name.h"
#include "firmware/console/operator_desk.h"
#include "model/io/socket_file.h"
#include "tests/firmware/console/desk_surroundings.h"

namespace tact::firmware::console::desk_by_socket_test {

using loop::State;

class DeskBySocket : public DeskSurroundings {
 protected:
  void SetUp() override {
    testing::internal::CaptureStderr();
    auto opened = ControlSocket::open(path);
    ASSERT_TRUE(opened) << opened.error().sentence;
    control = std::move(*opened);
    desk = std::make_unique<OperatorDesk>(
        signals, requests, view, [this] { return frame; }, control.get(), tick);
  }
  void TearDown() override {
    testing::internal::GetCapturedStderr();
    control.reset();
    std::filesystem::remove(path);
  }
  /// A person who has said it; hear() is the answer, once the desk has been at work.
  int say(const char* word) const {
    const auto address = model::io::socket_address(path);
    const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    EXPECT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&*address), sizeof *address), 0);
    EXPECT_GT(send(fd, word, strlen(word), 0), 0);
    return fd;
  }
  static Answer hear(int fd) {
    std::array<char, kLongestControlMessage> message{};
    const auto n = recv(fd, message.data(), message.size(), MSG_DONTWAIT);
    close(fd);
    EXPECT_GT(n, 0) << "no answer";
    return unpack_answer(std::string(message.data(), static_cast<std::size_t>(std::max(n, 0l))));
  }
  Answer ask(const char* word) {
    const int fd = say(word);
    desk->obey(1'000'000'000);
    return hear(fd);
  }
  void show(State state) {
    frame.state = state;
    desk->obey(0);
  }

  std::string path = control_path(testing::TempDir(), "liver.toml", getpid());
  std::unique_ptr<ControlSocket> control;
  std::unique_ptr<OperatorDesk> desk;
};

TEST_F(DeskBySocket, ArmsOnlyAfterTheWordsAndSaysWhichDevice) {
  const Answer early = ask("arm");
  EXPECT_FALSE(early.done);
  EXPECT_EQ(early.sentence, "puppet: not armed: the device is not ready yet");
  EXPECT_EQ(requests.refused.load(), 1u);
  show(State::kReady);
  const Answer armed = ask("arm");
  EXPECT_TRUE(armed.done);
  EXPECT_EQ(armed.sentence, "puppet: armed, force is on");
  EXPECT_EQ(edges, (std::vector<std::string>{"arm"}));
}

TEST_F(DeskBySocket, WhatWaitsWhileTheWordsAreToldIsRefused) {
  const std::array<int, 3> early{say("arm"), say("arm"), say("reset")};
  show(State::kReady);
  desk->obey(0);
  for (const int one : early)
    EXPECT_NE(hear(one).sentence.find("came before it was ready"), std::string::npos);
  EXPECT_TRUE(edges.empty()) << "queued";
  EXPECT_EQ(requests.refused.load(), 3u);
}

TEST_F(DeskBySocket, ResetsAStopAlone) {
  show(State::kReady);
  EXPECT_EQ(ask("reset").sentence, "puppet: not reset: it is ready, not stopped");
  show(State::kStopped);
  EXPECT_FALSE(ask("arm").done);
  EXPECT_TRUE(ask("reset").done);
  EXPECT_EQ(edges, (std::vector<std::string>{"reset"}));
}

TEST_F(DeskBySocket, DisarmsAtAnyTime) {
  EXPECT_TRUE(ask("disarm").done);
  show(State::kReady);
  show(State::kArmed);
  EXPECT_EQ(ask("disarm").sentence, "puppet: no force; arm it again when it shall have one");
  EXPECT_EQ(edges, (std::vector<std::string>{"disarm", "disarm"}));
}

TEST_F(DeskBySocket, ADisarmThatIsNotAnsweredStandsForTheNextTick) {
  show(State::kArmed);
  stands = true;
  const Answer answer = ask("disarm");
  EXPECT_FALSE(answer.done);
  EXPECT_NE(answer.sentence.find("its next tick takes the force away"), std::string::npos);
  EXPECT_EQ(static_cast<loop::Request>(requests.asked.load() & 3U), loop::Request::kDisarm);
}

TEST_F(DeskBySocket, AStopThatIsDisarmedStillHasToBeReset) {
  show(State::kStopped);
  EXPECT_EQ(ask("disarm").sentence, "puppet: no force; it has stopped: reset it, then arm it");
}

TEST_F(DeskBySocket, WhatWouldArmItselfWaitsForAPersonOnceItIsDisarmed) {
  OperatorView itself(device, lines, true);
  desk = std::make_unique<OperatorDesk>(
      signals, requests, itself, [this] { return frame; }, control.get(), tick);
  show(State::kReady);
  EXPECT_EQ(ask("arm").sentence, "puppet: not armed: it arms itself as soon as it has power");
  stands = true;
  EXPECT_FALSE(ask("disarm").done);
  EXPECT_FALSE(ask("arm").done);
  stands = false;
  EXPECT_TRUE(ask("disarm").done);
  show(State::kReady);  // and the words are told
  EXPECT_TRUE(ask("arm").done);
}

TEST_F(DeskBySocket, StopsAtAnyTimeEvenInTheMomentOfTheWords) {
  const int fd = say("stop");
  show(State::kReady);
  EXPECT_TRUE(hear(fd).done);
  EXPECT_TRUE(requests.stop.load());
}

TEST_F(DeskBySocket, ToldOfItsStateAndOfWordsThatItDoesNotKnow) {
  frame.force_N[0] = 3.0F, frame.force_N[1] = 4.0F;
  show(State::kArmed);
  EXPECT_EQ(ask("status").sentence, "puppet: armed, 5.000 N");
  frame.fault = static_cast<std::uint16_t>(model::Fault::kEmergencyStop);
  show(State::kStopped);
  const std::string stopped = ask("status").sentence;
  EXPECT_TRUE(stopped.starts_with("puppet: stopped, 5.000 N, fault ")) << stopped;
  EXPECT_FALSE(ask("ARM").done);
  EXPECT_TRUE(edges.empty());
}

TEST_F(DeskBySocket, ASignalAndAWordAtOnceAreTwoRequests) {
  show(State::kReady);
  const int fd = say("arm");
  raise(SIGUSR1);
  desk->obey(1'000'000'000);
  EXPECT_TRUE(hear(fd).done);
  EXPECT_EQ(requests.refused.load(), 1u) << "the reset";
}

TEST_F(DeskBySocket, WhatTheLoopRefusesIsTheAnswer) {
  refuses = true;
  show(State::kReady);
  const Answer answer = ask("arm");
  EXPECT_FALSE(answer.done);
  EXPECT_NE(answer.sentence.find("puppet: not armed: no power"), std::string::npos);
}

}  // namespace tact::firmware::console::desk_by_socket_test
