// SPDX-License-Identifier: Apache-2.0
// The update of a law's numbers: its transitions, and with a loop on simulated time.
#include "firmware/run/law_updater.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "tests/support/scene_loop.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::run::law_updater_test {

using Event = LawUpdater::Event;
using State = LawUpdater::State;

constexpr auto kPause = std::chrono::milliseconds(1);
constexpr int kMaxTries = 60'000;  // a minute
constexpr const char* kSofter = "rhombus.normal_stiffness_N_per_m=140";

TEST(LawUpdaterState, EachEventHasOneSuccessorOfEachState) {
  EXPECT_EQ(LawUpdater::next(State::kIdle, Event::kRequested), State::kPreparing);
  EXPECT_EQ(LawUpdater::next(State::kDeferred, Event::kRequested), State::kReplacing);
  EXPECT_EQ(LawUpdater::next(State::kPreparing, Event::kFailed), State::kIdle);
  EXPECT_EQ(LawUpdater::next(State::kReplacing, Event::kFailed), State::kDeferred);
  EXPECT_EQ(LawUpdater::next(State::kPreparing, Event::kPrepared), State::kOffered);
  EXPECT_EQ(LawUpdater::next(State::kReplacing, Event::kPrepared), State::kOffered);
  EXPECT_EQ(LawUpdater::next(State::kOffered, Event::kUsed), State::kIdle);
  EXPECT_EQ(LawUpdater::next(State::kDeferred, Event::kUsed), State::kIdle);
  EXPECT_EQ(LawUpdater::next(State::kReplacing, Event::kUsed), State::kPreparing);
  EXPECT_EQ(LawUpdater::next(State::kOffered, Event::kTimedOut), State::kDeferred);
}

/// The client's end of a request.
class Client {
 public:
  Client() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends_.data()), 0); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { close(ends_[0]); }
  console::ControlRequest request() { return {ends_[1], "set"}; }
  /// Empty: not answered yet. "closed": never answered.
  std::string answer() const {
    std::string message(console::kLongestControlMessage, '\0');
    const ssize_t size = recv(ends_[0], message.data(), message.size(), MSG_DONTWAIT);
    if (size < 0) return "";
    if (size == 0) return "closed";
    return console::unpack_answer(message.substr(0, static_cast<std::size_t>(size))).message;
  }

 private:
  std::array<int, 2> ends_{};
};

class LawUpdaterTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made =
        LawUpdater::make({scene, *run.device, run.requests, run.loop.contacts(), telemetry});
    ASSERT_TRUE(made);
    updater = std::move(*made);
    step(100);
  }
  void step(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      run.loop.step();
      telemetry.drain();
    }
  }
  void step_until_clear(bool clear) {
    for (int i = 0; i < 5000 && run.controller.is_clear() != clear; ++i) step();
    ASSERT_EQ(run.controller.is_clear(), clear);
  }
  /// Polls until the thread has prepared the tissue, or could not; the report of the last poll.
  std::string poll_until_prepared() {
    const auto is_preparing = [this] {
      return updater->state() == State::kPreparing || updater->state() == State::kReplacing;
    };
    std::optional<std::string> report;
    for (int i = 0; i < kMaxTries && is_preparing(); ++i) {
      std::this_thread::sleep_for(kPause);
      report = updater->poll();
    }
    EXPECT_FALSE(is_preparing()) << "the thread has prepared nothing within a minute";
    return report.value_or("");
  }
  /// Times that the updater's thread has waited so far; 0 while it computes.
  static long waits_of_thread() {
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
      const std::string status = text_of(task.path() / "status");
      if (!status.starts_with("Name:\ttact-law\n")) continue;
      const std::size_t count = status.find("\nvoluntary_ctxt_switches:\t");
      return status.find("\nState:\tS") != std::string::npos ? std::stol(status.substr(count + 26))
                                                             : 0;
    }
    return 0;
  }
  static std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// A request whose tissue the thread has prepared, before any poll.
  void request_and_prepare(Client& of, const std::string& set) {
    for (int i = 0; i < kMaxTries && waits_of_thread() == 0; ++i)
      std::this_thread::sleep_for(kPause);
    const long before = waits_of_thread();
    EXPECT_FALSE(updater->request(of.request(), set));
    for (int i = 0; i < kMaxTries && waits_of_thread() <= before; ++i)
      std::this_thread::sleep_for(kPause);
    ASSERT_GT(waits_of_thread(), before);
  }
  std::string poll() { return updater->poll().value_or(""); }
  /// In contact, with an offer whose client has its answer.
  void defer(Client& first) {
    step_until_clear(false);
    EXPECT_FALSE(updater->request(first.request(), kSofter));
    poll_until_prepared();
    for (int i = 0; i < LawUpdater::kMaxPolls; ++i) poll();
    ASSERT_EQ(updater->state(), State::kDeferred);
  }

  model::scene::Scene scene = tests::make_plate_scene();
  tests::SceneLoop run{scene};
  telemetry::Telemetry telemetry{
      *run.ring,
      telemetry::FrameBuilder(run.tissue->law().contact_law(), run.controller.shapes(), false),
      {},
      {}};
  Client client, second;
  std::unique_ptr<LawUpdater> updater;
};

TEST_F(LawUpdaterTest, ARequestWhileIdleIsPreparedOfferedAndUsed) {
  EXPECT_EQ(updater->state(), State::kIdle);
  EXPECT_FALSE(updater->request(client.request(), kSofter));
  EXPECT_EQ(updater->state(), State::kPreparing);
  EXPECT_EQ(poll_until_prepared(), "");
  EXPECT_EQ(updater->state(), State::kOffered);
  EXPECT_EQ(client.answer(), "") << "before the loop has taken it";
  step();
  EXPECT_EQ(poll(), std::string(kSofter) + ": set");
  EXPECT_EQ(client.answer(), std::string(kSofter) + ": set");
  EXPECT_EQ(updater->state(), State::kIdle);
  EXPECT_EQ(telemetry.variant(), 1u);
}

TEST_F(LawUpdaterTest, ARequestWhilePreparingIsRefused) {
  EXPECT_FALSE(updater->request(client.request(), kSofter));
  EXPECT_EQ(updater->request(second.request(), kSofter),
            "not set: other numbers are being prepared; ask again");
  EXPECT_EQ(second.answer(), "not set: other numbers are being prepared; ask again");
  EXPECT_EQ(run.requests.refused.load(), 1u);
  EXPECT_EQ(updater->state(), State::kPreparing);
}

TEST_F(LawUpdaterTest, ARequestWhileOfferedIsRefused) {
  EXPECT_FALSE(updater->request(client.request(), kSofter));
  poll_until_prepared();
  EXPECT_TRUE(updater->request(second.request(), kSofter));
  EXPECT_EQ(updater->state(), State::kOffered);
  step();
  EXPECT_EQ(poll(), std::string(kSofter) + ": set") << "the first request is not disturbed";
}

TEST_F(LawUpdaterTest, AnOlderOfferIsReportedAsUsedWhenTheNewerIsPrepared) {
  defer(client);
  request_and_prepare(second, "rhombus.normal_stiffness_N_per_m=130");
  EXPECT_EQ(updater->state(), State::kReplacing);
  step_until_clear(true);
  step();
  EXPECT_EQ(poll(), std::string(kSofter) + ": set");
  poll_until_prepared();
  EXPECT_EQ(updater->state(), State::kOffered);
}

TEST_F(LawUpdaterTest, NumbersThatCannotBePreparedAreRefusedAndForgotten) {
  EXPECT_FALSE(updater->request(client.request(), "rhombus.growth=1e9"));
  EXPECT_EQ(poll_until_prepared().substr(0, 30), "not set: rhombus.growth = 1e9:");
  EXPECT_EQ(client.answer().substr(0, 30), "not set: rhombus.growth = 1e9:");
  EXPECT_EQ(updater->state(), State::kIdle);
  EXPECT_EQ(updater->count(), 0u);
  EXPECT_FALSE(updater->request(second.request(), kSofter));
  poll_until_prepared();
  EXPECT_EQ(updater->state(), State::kOffered) << "without the number that was refused";
}

TEST_F(LawUpdaterTest, AnOfferWaitsUntilTheToolIsOutOfContact) {
  defer(client);
  EXPECT_EQ(client.answer(),
            std::string(kSofter) + ": prepared, used as soon as the tool is out of contact");
  EXPECT_EQ(poll(), "") << "reported once";
  EXPECT_EQ(telemetry.variant(), 0u);
  step_until_clear(true);
  step();
  EXPECT_EQ(poll(), std::string(kSofter) + ": set");
  EXPECT_EQ(updater->state(), State::kIdle);
}

TEST_F(LawUpdaterTest, ANewerRequestReplacesADeferredOffer) {
  defer(client);
  EXPECT_FALSE(updater->request(second.request(), "rhombus.growth=2.1"));
  EXPECT_EQ(updater->state(), State::kReplacing);
  poll_until_prepared();
  EXPECT_EQ(updater->state(), State::kOffered);
  step_until_clear(true);
  step();
  EXPECT_EQ(poll(), "rhombus.growth=2.1: set");
  EXPECT_EQ(telemetry.variant(), 2u) << "the older one was never used";
  EXPECT_EQ(updater->count(), 2u);
}

TEST_F(LawUpdaterTest, AReplacementThatFailsLeavesTheDeferredOffer) {
  defer(client);
  EXPECT_FALSE(updater->request(second.request(), "rhombus.growth=1e9"));
  poll_until_prepared();
  EXPECT_EQ(updater->state(), State::kDeferred);
  EXPECT_EQ(second.answer().substr(0, 30), "not set: rhombus.growth = 1e9:");
  step_until_clear(true);
  step();
  EXPECT_EQ(poll(), std::string(kSofter) + ": set");
}

TEST_F(LawUpdaterTest, AShutdownWhilePreparingClosesTheRequest) {
  EXPECT_FALSE(updater->request(client.request(), kSofter));
  updater.reset();
  EXPECT_EQ(client.answer(), "closed");
}

}  // namespace tact::firmware::run::law_updater_test
