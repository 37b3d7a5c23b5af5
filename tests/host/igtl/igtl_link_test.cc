// SPDX-License-Identifier: Apache-2.0
// The viewer's link against OpenIGTLink's own client and server.
#include "host/igtl/igtl_link.h"

#include <gtest/gtest.h>
#include <igtlSensorMessage.h>
#include <igtlServerSocket.h>
#include <igtlStatusMessage.h>

#include <cmath>
#include <map>

#include "tests/host/igtl/link_fixture.h"
#include "tests/support/program.h"

namespace tact::host::igtl::igtl_link_test {

using boost::asio::ip::tcp;
using tests::message_of;
using tests::Received;
using tests::transform_of;
using tracking::BodyRole;
using tracking::BodyState;

using Link = tests::IgtlPeers;

TEST_F(Link, TheLibrarysClientGetsPoseForceAndStatus) {
  ASSERT_EQ(open(), "");
  auto socket = client();
  ASSERT_TRUE(becomes([this] { return link_.clients() == 1; }));
  show(2.5f);
  Received got;
  std::map<std::string, int> seen;
  std::string status;
  while (status != "armed" && got.next(socket)) {
    ++seen[got.device];
    if (got.type == "TRANSFORM") {
      ::igtl::Matrix4x4 m;
      got.as<::igtl::TransformMessage>(socket)->GetMatrix(m);
      EXPECT_FLOAT_EQ(m[1][3], 125.0f);
      EXPECT_FLOAT_EQ(m[2][2], got.device == "ForceToDevice" ? 2.5f : 1.0f);
    } else if (got.type == "SENSOR") {
      EXPECT_EQ(got.as<::igtl::SensorMessage>(socket)->GetValue(2), 2.5);
    } else {
      status = got.as<::igtl::StatusMessage>(socket)->GetStatusString();
    }
  }
  EXPECT_EQ(seen, (std::map<std::string, int>{
                      {"ToolToDevice", 1}, {"ForceToDevice", 1}, {"Force", 1}, {"Tact", 2}}));
  ask([this] { return link_.lose(), 0; });
  ASSERT_TRUE(got.next(socket));
  EXPECT_EQ(got.as<::igtl::StatusMessage>(socket)->GetCode(),
            ::igtl::StatusMessage::STATUS_TIME_OUT);
}

TEST_F(Link, SendsNoMoreThanItsRate) {
  ASSERT_EQ(open(), "");
  auto socket = client();
  ASSERT_TRUE(becomes([this] { return link_.clients() == 1; }));
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 200; ++i) show(1.0f);
  const auto took = std::chrono::steady_clock::now() - start;
  socket->SetTimeout(300);
  Received got;
  int poses = 0;
  while (got.next(socket)) {
    poses += got.device == "ToolToDevice";
    socket->Skip(static_cast<int>(got.header->GetBodySizeToRead()));
  }
  EXPECT_GE(poses, 1);
  EXPECT_LE(poses, 2 + took / kFrameGap + took / kStatusGap);
}

TEST_F(Link, TheLibrarysTransformMovesTheHead) {
  ASSERT_EQ(open(), "");
  auto socket = client();
  const std::string bytes = transform_of("HeadToDevice", 250.0f);
  ASSERT_NE(socket->Send(bytes.data(), static_cast<int>(bytes.size())), 0);
  ASSERT_TRUE(
      becomes([this] { return link_.now()[BodyRole::kHead].state == BodyState::kTracked; }));
  EXPECT_NEAR(head().raw.position_m.x(), 0.25, 1e-9);
  EXPECT_EQ(ask([this] { return link_.now()[BodyRole::kWaist].state; }), BodyState::kAbsent);
}

TEST_F(Link, GoesToAServerOfTrackersAndComesBackToIt) {
  auto server = ::igtl::ServerSocket::New();
  ASSERT_EQ(server->CreateServer(0), 0);
  const std::string at = "127.0.0.1:" + std::to_string(server->GetServerPort());
  ASSERT_EQ(open({.port = {}, .from = at}), "");
  for (const float x_mm : {100.0f, 120.0f}) {
    auto connection = server->WaitForConnection(5000);
    ASSERT_TRUE(connection.IsNotNull());
    const std::string bytes = transform_of("Head", x_mm);
    ASSERT_NE(connection->Send(bytes.data(), static_cast<int>(bytes.size())), 0);
    ASSERT_TRUE(becomes([&] {
      return std::abs(link_.now()[BodyRole::kHead].raw.position_m.x() -
                      1e-3 * static_cast<double>(x_mm)) < 1e-9;
    }));
    show(1.0f);  // of which the server hears nothing
    connection->SetReceiveTimeout(100);
    char byte = 0;
    EXPECT_LE(connection->Receive(&byte, 1), 0);
    connection->CloseSocket();
    ASSERT_TRUE(becomes([this] { return !said_.empty(); }));
  }
}

TEST_F(Link, ListensToThisMachineAloneAndSaysWhenItDoesNot) {
  ASSERT_EQ(open(), "");
  EXPECT_EQ(said(), "");
  // Another address of this machine is free: it is bound to 127.0.0.1 alone.
  tcp::acceptor other(other_);
  other.open(tcp::v4());
  boost::system::error_code wrong;
  other.bind({boost::asio::ip::make_address("127.0.0.2"), link_.port()}, wrong);
  EXPECT_FALSE(wrong);
}

TEST(LinkOptions, SayWhatIsWrongWithThem) {
  boost::asio::io_context io;
  std::vector<std::string> said;
  const auto opened = [&](const IgtlOptions& options) {
    IgtlLink link(io, [&](const std::string& message) { said.push_back(message); });
    return message_of(link.open(options));
  };
  EXPECT_FALSE(IgtlOptions{}.is_asked_for()) << "off by default";
  EXPECT_EQ(opened({.port = 0, .bind_address = "0.0.0.0"}), "");
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("there is no password"), std::string::npos);
  EXPECT_NE(opened({.port = 0, .bind_address = "here"}).find("--igtl-bind here: not an IP"),
            std::string::npos);
  for (const char* from : {"", "plus", "127.0.0.1", "127.0.0.1:", "127.0.0.1:0", "127.0.0.1:99999",
                           "127.0.0.1:1x", ":18944"})
    EXPECT_EQ(opened({.port = {}, .from = from}).empty(), std::string(from).empty()) << from;
  EXPECT_EQ(opened({.port = {}, .from = "[::1]:18944"}), "");
  tcp::acceptor taken(io, {boost::asio::ip::address_v4::loopback(), 0});
  const std::uint16_t port = taken.local_endpoint().port();
  EXPECT_NE(opened({.port = port}).find("choose another"), std::string::npos);
}

TEST(LinkOptions, TheProgramRefusesThemWithAMessage) {
  for (const auto& [options, words] :
       {std::pair{"--igtl 70000", "--igtl"}, std::pair{"--igtl-bind 127.0.0.1", "--igtl"},
        std::pair{"--igtl-from plus", "not an IP address and a port"},
        std::pair{"--igtl 0 --open x", "--open"}}) {
    const tests::Outcome done = tests::run_program("tact-view", options);
    EXPECT_EQ(done.status, 2) << options << ": " << done.output;
    EXPECT_NE(done.output.find(words), std::string::npos) << done.output;
  }
}

}  // namespace tact::host::igtl::igtl_link_test
