// SPDX-License-Identifier: Apache-2.0
// The viewer's link against OpenIGTLink's own client and server, and against what no client sends.
#include "host/igtl/igtl_link.h"

#include <gtest/gtest.h>
#include <igtlClientSocket.h>
#include <igtlSensorMessage.h>
#include <igtlServerSocket.h>
#include <igtlStatusMessage.h>
#include <igtlTransformMessage.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cmath>
#include <future>
#include <map>
#include <thread>

#include "tests/support/program.h"
#include "tests/support/sentence.h"

namespace tact::host::igtl::igtl_link_test {

using boost::asio::ip::tcp;
using tests::sentence_of;
using tracking::BodyRole;
using tracking::BodyState;

class Link : public testing::Test {
 protected:
  /// By its thread.
  template <typename Question>
  auto ask(const Question& question) {
    std::promise<decltype(question())> answer;
    auto future = answer.get_future();
    boost::asio::post(io_, [&] { answer.set_value(question()); });
    return future.get();
  }
  ~Link() override {
    if (!thread_.joinable()) return;
    ask([this] { return link_.stop(), 0; });
    work_.reset();
    io_.stop();
    thread_.join();
  }
  /// The link in a thread of its own.
  std::string open(const IgtlOptions& options = {.port = 0}) {
    const std::string wrong = sentence_of(link_.open(options));
    if (!wrong.empty()) return wrong;
    link_.start();
    thread_ = std::thread([this] { io_.run(); });
    return {};
  }
  template <typename Condition>
  bool becomes(const Condition& condition) {
    for (int i = 0; i < 500; ++i) {
      if (ask(condition)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  std::size_t clients() {
    return ask([this] { return link_.clients(); });
  }
  std::uint64_t refused() {
    return ask([this] { return link_.refused(); });
  }
  std::string said() {
    return ask([this] { return said_.empty() ? std::string() : said_.back(); });
  }
  tracking::TrackedBody head() {
    return ask([this] { return link_.now()[BodyRole::kHead]; });
  }
  ::igtl::ClientSocket::Pointer client() {
    auto socket = ::igtl::ClientSocket::New();
    EXPECT_EQ(socket->ConnectToServer("127.0.0.1", link_.port()), 0);
    socket->SetTimeout(3000);
    return socket;
  }
  tcp::socket raw_client() {
    tcp::socket socket(other_);
    socket.connect({boost::asio::ip::address_v4::loopback(), link_.port()});
    return socket;
  }
  void show(float force_N, firmware::loop::State state = firmware::loop::State::kArmed) {
    record::Frame frame;
    frame.tool_orientation[0] = 1.0f;
    frame.tool_position_m[1] = 0.125f;
    frame.force_N[2] = force_N;
    frame.state = state;
    ask([&] { return link_.add(frame), 0; });
  }

  boost::asio::io_context io_{1}, other_{1};
  std::vector<std::string> said_;
  IgtlLink link_{io_, [this](const std::string& sentence) { said_.push_back(sentence); }};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      io_.get_executor()};
  std::thread thread_;
};

std::string transform_of(const char* device, float x_mm) {
  auto message = ::igtl::TransformMessage::New();
  ::igtl::Matrix4x4 m{};
  m[0][0] = m[1][1] = m[2][2] = 1.0f;
  m[0][3] = x_mm;
  message->SetDeviceName(device);
  message->SetMatrix(m);
  message->Pack();
  return {static_cast<const char*>(message->GetPackPointer()),
          static_cast<std::size_t>(message->GetPackSize())};
}

/// The next message of the library's client as `Message`, its checksum judged; the type is told.
struct Received {
  std::string type, device;
  ::igtl::MessageHeader::Pointer header = ::igtl::MessageHeader::New();

  bool next(::igtl::ClientSocket::Pointer& socket) {
    header->InitPack();
    const int size = header->GetPackSize();
    if (socket->Receive(header->GetPackPointer(), size) != size) return false;
    header->Unpack();
    type = header->GetDeviceType();
    device = header->GetDeviceName();
    return true;
  }
  template <typename Message>
  typename Message::Pointer as(::igtl::ClientSocket::Pointer& socket) {
    auto message = Message::New();
    message->SetMessageHeader(header);
    message->AllocatePack();
    socket->Receive(message->GetPackBodyPointer(), message->GetPackBodySize());
    EXPECT_TRUE(message->Unpack(1) & ::igtl::MessageHeader::UNPACK_BODY) << type;
    return message;
  }
};

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
  EXPECT_LE(poses, 1 + took / kFrameGap);
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

TEST_F(Link, ADamagedMessageIsLeftOutAndTheNextIsTaken) {
  ASSERT_EQ(open(), "");
  tcp::socket socket = raw_client();
  std::string flipped = transform_of("Head", 900.0f);
  flipped[kHeaderBytes + 45] = static_cast<char>(flipped[kHeaderBytes + 45] ^ 1);
  std::string sized = transform_of("Head", 900.0f).substr(0, kHeaderBytes);
  const std::string short_body(40, '\1');
  sized[49] = 40;  // the last byte of the body's length
  for (int i = 0; i < 8; ++i)
    sized[50 + static_cast<std::size_t>(i)] = static_cast<char>(crc64(short_body) >> (8 * (7 - i)));
  std::string image(kHeaderBytes, '\0');
  image.replace(0, 7, std::string("\0\1IMAGE", 7));
  image[47] = 1;  // 65 536 bytes, read away
  boost::asio::write(
      socket, boost::asio::buffer(flipped + sized + short_body + image + std::string(65'536, 'x') +
                                  transform_of("Head", 300.0f)));
  ASSERT_TRUE(becomes([this] { return link_.now()[BodyRole::kHead].state != BodyState::kAbsent; }));
  EXPECT_NEAR(head().raw.position_m.x(), 0.3, 1e-6);
  EXPECT_EQ(refused(), 2u);
  EXPECT_NE(said().find("its checksum is not that of its bytes"), std::string::npos) << said();
  EXPECT_EQ(clients(), 1u);
}

TEST_F(Link, AHugeLengthOrNoHeaderEndsTheConnection) {
  ASSERT_EQ(open(), "");
  for (const char* kind : {"TRANSFORM", "IMAGE", "http"}) {
    tcp::socket socket = raw_client();
    std::string bytes(kHeaderBytes, '\0');
    bytes[1] = 1;
    bytes.replace(2, std::string(kind).size(), kind);
    if (std::string(kind) == "http")
      bytes = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" + std::string(100, ' ');
    else
      bytes.replace(42, 8,
                    kind[0] == 'T' ? std::string("\0\0\0\0\0\0\x10\1", 8) : std::string(8, '\x7f'));
    boost::asio::write(socket, boost::asio::buffer(bytes));
    char byte[200];
    boost::system::error_code wrong;
    boost::asio::read(socket, boost::asio::buffer(byte), wrong);  // past its first status
    EXPECT_TRUE(wrong) << kind;
    EXPECT_TRUE(becomes([this] { return link_.clients() == 0; })) << kind;
  }
  EXPECT_EQ(refused(), 3u);
  EXPECT_NE(said().find("it announces a TRANSFORM of 4097 bytes"), std::string::npos) << said();
}

TEST_F(Link, WhoDoesNotReadHoldsNobodyUp) {
  ASSERT_EQ(open(), "");
  tcp::socket lazy = raw_client();
  auto socket = client();
  ASSERT_TRUE(becomes([this] { return link_.clients() == 2; }));
  record::Frame frame;
  frame.tool_orientation[0] = 1.0f;
  // A status that changes each time is sent each time: more than the kernel keeps.
  for (int i = 0; i < 40'000; ++i) {
    frame.fault = static_cast<std::uint16_t>(i % 1000 + 1);
    ask([&] { return link_.add(frame), 0; });
  }
  frame.fault = 0;
  frame.state = firmware::loop::State::kReady;
  std::this_thread::sleep_for(kFrameGap);
  ask([&] { return link_.add(frame), 0; });
  Received got;
  std::string words;
  while (words != "ready" && got.next(socket))
    if (got.type == "STATUS")
      words = got.as<::igtl::StatusMessage>(socket)->GetStatusString();
    else
      socket->Skip(static_cast<int>(got.header->GetBodySizeToRead()));
  EXPECT_EQ(words, "ready") << "who reads has the newest in the end";
  EXPECT_EQ(clients(), 2u);
}

TEST_F(Link, MoreThanEightAreSentAway) {
  ASSERT_EQ(open(), "");
  std::vector<tcp::socket> sockets;
  for (std::size_t i = 0; i < kMostClients; ++i) sockets.push_back(raw_client());
  ASSERT_TRUE(becomes([this] { return link_.clients() == kMostClients; }));
  tcp::socket ninth = raw_client();
  char byte = 0;
  boost::system::error_code wrong;
  boost::asio::read(ninth, boost::asio::buffer(&byte, 1), wrong);
  EXPECT_TRUE(wrong);
  sockets.pop_back();
  EXPECT_TRUE(becomes([this] { return link_.clients() == kMostClients - 1; }));
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
    IgtlLink link(io, [&](const std::string& sentence) { said.push_back(sentence); });
    return sentence_of(link.open(options));
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

TEST(LinkOptions, TheProgramRefusesThemInASentence) {
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
