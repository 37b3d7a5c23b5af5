// SPDX-License-Identifier: Apache-2.0
// What a person asks of a running tactd by its socket: done, or refused with the reason. Arming is
// an act, made once, when it may be.
#include "firmware/console/request_handler.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "firmware/console/control_name.h"
#include "model/io/socket_file.h"
#include "model/time_ns.h"
#include "tests/support/puppet_loop.h"

namespace tact::firmware::console::request_handler_test {

using loop::State;

class Requests : public testing::Test {
 protected:
  void SetUp() override {
    testing::internal::CaptureStderr();
    auto opened = ControlSocket::open(path);
    ASSERT_TRUE(opened) << opened.error().message;
    control = std::move(*opened);
    request_handler = make_handler(view, tick);
  }
  void TearDown() override {
    testing::internal::GetCapturedStderr();
    control.reset();
    std::filesystem::remove(path);
  }
  std::unique_ptr<RequestHandler> make_handler(OperatorView& of, std::function<void()> pause) {
    return std::make_unique<RequestHandler>(
        signals, requests, of, [this] { return frame; }, control.get(), &progress,
        std::move(pause));
  }
  /// A person who has said it; hear() is the answer, once the handler has been at work.
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
    request_handler->serve(1'000'000'000);
    return hear(fd);
  }
  std::string refusal(const char* word) {
    const Answer answer = ask(word);
    EXPECT_FALSE(answer.done);
    return answer.message;
  }
  /// The terminal's output meanwhile.
  std::string show(State state) {
    testing::internal::GetCapturedStderr();
    testing::internal::CaptureStderr();
    frame.state = state;
    request_handler->serve(0);
    const std::string reported = testing::internal::GetCapturedStderr();
    testing::internal::CaptureStderr();
    return reported;
  }

  loop::SimulatedClock clock;
  PuppetDevice device{clock};
  PuppetLines lines;
  loop::Requests requests;
  std::vector<std::string> edges;  // what the loop was asked
  bool refuses = false, is_silent = false;
  int pauses = 0;
  OperatorSignals signals;
  std::function<void()> tick = [this] {
    ++pauses;
    const std::uint32_t asked = requests.asked.load();
    if (is_silent) return;
    edges.emplace_back(std::array{"none", "arm", "reset", "disarm"}[asked & 3U]);
    requests.echo(asked, !refuses);
  };
  OperatorView view{device, lines, false};
  protocol::Frame frame;
  loop::Progress progress;
  std::string path = control_path(testing::TempDir(), "liver.toml", getpid());
  std::unique_ptr<ControlSocket> control;
  std::unique_ptr<RequestHandler> request_handler;
};

TEST_F(Requests, ArmsOnlyAfterTheReadyMessage) {
  EXPECT_EQ(refusal("arm"), "puppet: not armed: the device is not ready yet");
  show(State::kOff);
  EXPECT_NE(refusal("arm").find("not armed"), std::string::npos);
  EXPECT_TRUE(edges.empty());
  EXPECT_EQ(requests.refused.load(), 2u);
  EXPECT_NE(show(State::kReady).find("ready, force is off"), std::string::npos);
  const Answer armed = ask("arm");
  EXPECT_TRUE(armed.done);
  EXPECT_EQ(armed.message, "puppet: armed, force is on");
  EXPECT_EQ(edges, (std::vector<std::string>{"arm"}));
  EXPECT_EQ(requests.refused.load(), 2u);
}

TEST_F(Requests, AnswersByTheLoopsOwnCountersWithTheirAge) {
  show(State::kArmed);
  const auto now_ns = [] { return loop::MonotonicClock().now_ns(); };
  progress.show({.time_ns = now_ns(),
                 .state = State::kStopped,
                 .fault = model::Fault::kLoopLate,
                 .force_N = {0.0f, 0.0f, 0.25f}});
  EXPECT_TRUE(ask("status").done);
  const std::string reported = ask("status").message;
  EXPECT_TRUE(reported.starts_with("puppet: stopped, 0.250 N, fault 105, ")) << reported;
  EXPECT_TRUE(reported.ends_with(" ms ago")) << reported;
  EXPECT_NE(refusal("arm").find("it has stopped"), std::string::npos);
  progress.show({.time_ns = now_ns() - 60 * model::kMillisecond_ns, .state = State::kArmed});
  EXPECT_NE(refusal("status").find("not answered: the loop has stopped; puppet: armed"),
            std::string::npos);
  requests.trip(model::Fault::kLoopStalled);
  EXPECT_NE(refusal("status").find("stopped, 0.000 N, fault 120"), std::string::npos);
}

TEST_F(Requests, RequestBeforeTheReadyMessageIsRefused) {
  const std::array<int, 3> early{say("arm"), say("arm"), say("reset")};
  show(State::kReady);
  request_handler->serve(0);
  for (const int one : early)
    EXPECT_NE(hear(one).message.find("came before it was ready"), std::string::npos);
  EXPECT_TRUE(edges.empty()) << "queued";
  EXPECT_EQ(requests.refused.load(), 3u);
}

TEST_F(Requests, ResetOnlyAfterAStopAndArmingNeedsANewReadyMessage) {
  show(State::kReady);
  EXPECT_EQ(refusal("reset"), "puppet: not reset: it is ready, not stopped");
  show(State::kArmed);
  EXPECT_NE(refusal("arm").find("armed already"), std::string::npos);
  show(State::kStopped);
  EXPECT_NE(refusal("arm").find("reset it first"), std::string::npos);
  EXPECT_TRUE(edges.empty());
  EXPECT_TRUE(ask("reset").done);
  EXPECT_EQ(edges, (std::vector<std::string>{"reset"}));
  EXPECT_FALSE(ask("arm").done) << "the words were not printed yet";
  EXPECT_NE(show(State::kReady).find("ready, force is off"), std::string::npos);
  EXPECT_TRUE(ask("arm").done);
  EXPECT_EQ(edges.back(), "arm");
}

TEST_F(Requests, RefusalOfTheLoopIsTheAnswerToTheRequest) {
  refuses = true;
  show(State::kReady);
  EXPECT_NE(refusal("arm").find("puppet: not armed: no power"), std::string::npos);
  EXPECT_EQ(pauses, 1) << "the echo ends the wait";
}

TEST_F(Requests, ALoopThatDoesNotAnswerIsNotAskedLater) {
  is_silent = true;
  show(State::kReady);
  EXPECT_NE(refusal("arm").find("not armed: the loop gives no answer"), std::string::npos);
  EXPECT_EQ(requests.asked.load() & 3U, 0U) << "taken back";
  EXPECT_LT(pauses, 500) << "of 1 ms; five requests in a row stay below WatchdogSec";
}

TEST_F(Requests, ARequestDoneBeforeItsCancellationIsAnsweredAsDone) {
  std::uint32_t taken = 0;  // by a tick that ends after the handler has given up
  request_handler = make_handler(view, [&] {
    const std::uint32_t asked = requests.asked.load();
    if ((asked & 3U) != 0) taken = asked;
    if ((asked & 3U) == 0) requests.echo(taken, true);
  });
  show(State::kReady);
  EXPECT_TRUE(ask("arm").done);
  EXPECT_EQ(requests.asked.load() & 3U, 0U);
}

TEST_F(Requests, ADeviceThatArmsItselfAtTheStartWaitsForAPersonAfterAStop) {
  OperatorView itself(device, lines, true);
  request_handler = make_handler(itself, tick);
  for (const State state : {State::kReady, State::kArmed, State::kStopped, State::kReady}) {
    const std::string words = show(state);
    EXPECT_EQ(words.find("ready, force is off") != std::string::npos,
              state == State::kReady && !itself.why_not_arm().starts_with("it arms itself"))
        << words;
  }
  EXPECT_EQ(itself.why_not_arm(), "");
}

TEST_F(Requests, DisarmsAtAnyTime) {
  EXPECT_TRUE(ask("disarm").done);
  show(State::kReady);
  show(State::kArmed);
  EXPECT_EQ(ask("disarm").message, "puppet: no force; arm it again when it shall have one");
  EXPECT_EQ(edges, (std::vector<std::string>{"disarm", "disarm"}));
}

TEST_F(Requests, AnUnansweredDisarmIsKeptForTheNextTick) {
  show(State::kArmed);
  is_silent = true;
  const Answer answer = ask("disarm");
  EXPECT_FALSE(answer.done);
  EXPECT_NE(answer.message.find("its next tick takes the force away"), std::string::npos);
  EXPECT_EQ(static_cast<loop::Request>(requests.asked.load() & 3U), loop::Request::kDisarm);
}

TEST_F(Requests, AStopThatIsDisarmedStillHasToBeReset) {
  show(State::kStopped);
  EXPECT_EQ(ask("disarm").message, "puppet: no force; it has stopped: reset it, then arm it");
}

TEST_F(Requests, SelfArmingDeviceNeedsAnArmRequestAfterADisarm) {
  OperatorView itself(device, lines, true);
  request_handler = make_handler(itself, tick);
  show(State::kReady);
  EXPECT_EQ(ask("arm").message, "puppet: not armed: it arms itself as soon as it has power");
  is_silent = true;
  EXPECT_FALSE(ask("disarm").done);
  EXPECT_FALSE(ask("arm").done);
  is_silent = false;
  EXPECT_TRUE(ask("disarm").done);
  show(State::kReady);  // and the words are printed
  EXPECT_TRUE(ask("arm").done);
}

TEST_F(Requests, StopIsExecutedEvenDuringTheReadyMessage) {
  const int fd = say("stop");
  show(State::kReady);
  EXPECT_TRUE(hear(fd).done);
  EXPECT_TRUE(requests.stop.load());
}

TEST_F(Requests, ReportsItsStateAndRefusesUnknownWords) {
  frame.force_N[0] = 3.0F, frame.force_N[1] = 4.0F;
  show(State::kArmed);
  EXPECT_EQ(ask("status").message, "puppet: armed, 5.000 N");
  frame.fault = static_cast<std::uint16_t>(model::Fault::kEmergencyStop);
  show(State::kStopped);
  const std::string stopped = ask("status").message;
  EXPECT_TRUE(stopped.starts_with("puppet: stopped, 5.000 N, fault ")) << stopped;
  EXPECT_FALSE(ask("ARM").done);
  EXPECT_TRUE(edges.empty());
}

TEST_F(Requests, AnEventIsAnsweredByItsTickAndIsNotKeptForLater) {
  request_handler = make_handler(view, [this] { static_cast<void>(requests.take_event(41)); });
  EXPECT_EQ(ask("event 7").message, "event 7 in tick 41");
  request_handler = make_handler(view, tick);  // does not take it
  EXPECT_EQ(refusal("event 8"), "puppet: no event: the loop gives no answer");
  EXPECT_EQ(requests.take_event(42), 0);
  for (const char* wrong : {"event 0", "event 256", "event -1", "event 1x", "event "})
    EXPECT_EQ(refusal(wrong), "event takes a number from 1 to 255") << wrong;
}

TEST_F(Requests, ASignalToEndIsHeardBesideARequest) {
  show(State::kReady);
  const int fd = say("status");
  raise(SIGTERM);
  request_handler->serve(1'000'000'000);
  EXPECT_TRUE(hear(fd).done);
  EXPECT_TRUE(requests.stop.load());
}

}  // namespace tact::firmware::console::request_handler_test
