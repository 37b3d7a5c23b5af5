// SPDX-License-Identifier: Apache-2.0
// The tracker's input: datagrams, a recorded file.
#include "host/tracking/operator_tracking.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <boost/asio/buffer.hpp>
#include <chrono>
#include <filesystem>

#include "tests/support/message.h"
#include "tests/support/tracking_views.h"

namespace tact::host::tracking::operator_tracking_test {

using tests::message_of;

using boost::asio::ip::udp;

const TrackingCamera kEye = test::camera("front", Pose{});

Pose hand_at(double x_m) {
  return {.rotation = test::turn(0.5, {1, 2, 3}), .position_m = {x_m, 0.0, 1.5}};
}

class Input : public ::testing::Test {
 protected:
  Input() : folder_("/tmp/tact-input-" + std::to_string(getpid())) {
    std::filesystem::create_directory(folder_);
  }
  ~Input() override { std::filesystem::remove_all(folder_); }

  std::string open(const std::string& input, const std::string& more = {}) {
    path_ = folder_ + "/desk.tracking.toml";
    test::write_file(path_, test::description(input, {{"h", "hand"}}, more));
    return message_of(tracking_.open(path_));
  }
  /// A free port, by asking the kernel for one.
  static std::uint16_t free_port() {
    boost::asio::io_context io;
    udp::socket socket(io, {boost::asio::ip::address_v4::loopback(), 0});
    return socket.local_endpoint().port();
  }
  void send(const std::string& bytes) {
    sender_.send_to(boost::asio::buffer(bytes),
                    {boost::asio::ip::address_v4::loopback(), tracking_.port()});
  }
  static std::string line(double x_m, double time_s, std::uint64_t sequence) {
    return test::line_of(test::look(kEye, Pose{}, "h", hand_at(x_m), time_s, sequence));
  }
  /// Runs the input until the condition holds, at most a minute.
  template <typename Condition>
  bool run_until(const Condition& condition) {
    for (int i = 0; i < 12000 && !condition(); ++i) {
      io_.restart();
      io_.run_for(std::chrono::milliseconds(5));
    }
    return condition();
  }
  /// Sends the pose again until it is seen: on a busy machine one datagram may be found only after
  /// the time from which a body counts as silent.
  bool tracked_by_sends(double x_m, std::uint64_t sequence) {
    return run_until([&] {
      const bool tracked = hand().state == BodyState::kTracked;
      if (!tracked) send(line(x_m, static_cast<double>(sequence), sequence));
      ++sequence;
      return tracked;
    });
  }
  const TrackedBody& hand() { return tracking_.now()[BodyRole::kHand]; }

  std::string folder_, path_;
  boost::asio::io_context io_{1};
  udp::socket sender_{io_, udp::v4()};
  std::vector<std::string> said_;
  OperatorTracking tracking_{io_, [this](const std::string& text) { said_.push_back(text); }};
};

TEST_F(Input, ADatagramBecomesAPose) {
  ASSERT_EQ(open("udp_port = " + std::to_string(free_port())), "");
  tracking_.start();
  EXPECT_EQ(hand().state, BodyState::kLost);
  ASSERT_TRUE(tracked_by_sends(0.25, 1));
  EXPECT_LT((hand().raw.position_m - hand_at(0.25).position_m).norm(), 1e-5);
  EXPECT_EQ(tracking_.refused(), 0u);
  ASSERT_TRUE(run_until([&] { return hand().state == BodyState::kLost; }));  // nothing more comes
  EXPECT_EQ(hand().trouble, TrackingTrouble::kSilent);
}

TEST_F(Input, BadDatagramsAreCountedAndTheFirstIsReported) {
  ASSERT_EQ(open("udp_port = " + std::to_string(free_port()),
                 "[registration]\nposition_m = [0, 0, "
                 "0]\nrotation_wxyz = [1, 0, 0, 0]\n"),
            "");
  tracking_.start();
  for (const std::string& bytes :
       {std::string("x"), std::string(), std::string(20000, '['), line(0, 1, 1).substr(0, 90)}) {
    send(bytes);
  }
  std::string strange = line(0.0, 1.0, 1);
  strange.replace(strange.find("front"), 5, "back_");
  send(strange);
  ASSERT_TRUE(run_until([&] { return tracking_.refused() == 5; }));
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find("no JSON object"), std::string::npos) << said_[0];
  EXPECT_TRUE(tracked_by_sends(0.1, 2));  // and the good ones go on
}

TEST_F(Input, MissingRegistrationIsReported) {
  ASSERT_EQ(open("udp_port = " + std::to_string(free_port())), "");
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find("there is no registration"), std::string::npos);
}

TEST_F(Input, APortInUseIsRefused) {
  udp::socket other(io_, {boost::asio::ip::address_v4::loopback(), 0});
  const std::string wrong = open("udp_port = " + std::to_string(other.local_endpoint().port()));
  EXPECT_NE(wrong.find("stop the other program or write another udp_port"), std::string::npos);
}

TEST_F(Input, ListensToThisMachineAlone) {
  ASSERT_EQ(open("udp_port = " + std::to_string(free_port())), "");
  // Another address of the same machine reaches it only if it is bound to more than 127.0.0.1.
  udp::socket other(io_, udp::v4());
  boost::system::error_code wrong;
  other.bind({boost::asio::ip::make_address("127.0.0.2"), tracking_.port()}, wrong);
  EXPECT_FALSE(wrong);
}

TEST_F(Input, AFileIsPlayedInItsOwnTimeAndAgain) {
  std::string text;
  for (int i = 0; i < 24; ++i)
    text += line(0.01 * i, 0.05 * i, static_cast<std::uint64_t>(i)) + "\n";
  test::write_file(folder_ + "/a.jsonl", text);
  ASSERT_EQ(open("recording = \"a.jsonl\""), "");
  const auto start = std::chrono::steady_clock::now();
  tracking_.start();
  const auto x_m = [&] { return hand().raw.position_m.x(); };
  const auto first = [&] { return hand().state == BodyState::kTracked && x_m() < 0.005; };
  ASSERT_TRUE(run_until(first));
  ASSERT_TRUE(run_until([&] { return x_m() > 0.225; }));
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(1150));
  ASSERT_TRUE(run_until(first));  // it begins again
  EXPECT_EQ(hand().trouble, TrackingTrouble::kNone);
  EXPECT_EQ(tracking_.refused(), 0u);
}

TEST_F(Input, AFileThatCannotBeginAgainIsRefused) {
  const std::string file = folder_ + "/a.jsonl";
  test::write_file(file, line(0.0, 5.0, 0) + "\n" + line(0.1, 6.0, 1) + "\n");
  const std::string wrong = open("recording = \"a.jsonl\"");
  EXPECT_TRUE(wrong.starts_with(file + ": camera front looks at body h for 1.00 s")) << wrong;
  EXPECT_NE(wrong.find("record longer"), std::string::npos) << wrong;
  // A long file in which another body comes for a moment is no better: that body is lost for ever.
  std::string moment = line(0.0, 5.5, 0);
  moment.replace(moment.find("\"h\""), 3, "\"t\"");
  const std::string good = line(0.0, 5.0, 0) + "\n" + line(0.1, 6.01, 1) + "\n";
  test::write_file(file, good + moment + "\n");
  EXPECT_NE(open("recording = \"a.jsonl\"").find("body t for 0.00 s"), std::string::npos);
  test::write_file(file, good);
  EXPECT_EQ(open("recording = \"a.jsonl\""), "");
}

TEST_F(Input, BadLinesOfAFileAreCountedAndTheFirstIsReportedWithItsLine) {
  test::write_file(folder_ + "/a.jsonl",
                   line(0.0, 0.0, 0) + "\nx\n\n" + line(0.0, 1.5, 1) + "\n{}\n");
  ASSERT_EQ(open("recording = \"a.jsonl\""), "");
  EXPECT_EQ(tracking_.refused(), 2u);
  EXPECT_NE(said_.at(said_.size() - 1).find("a.jsonl:2: it is no JSON"), std::string::npos);
  test::write_file(folder_ + "/a.jsonl", "\n");
  EXPECT_NE(open("recording = \"a.jsonl\"").find("it is empty"), std::string::npos);
  test::write_file(folder_ + "/a.jsonl", "x\n");
  EXPECT_NE(open("recording = \"a.jsonl\"").find("a.jsonl:1:"), std::string::npos);
  EXPECT_NE(open("recording = \"b.jsonl\"").find("no such file"), std::string::npos);
}

}  // namespace tact::host::tracking::operator_tracking_test
