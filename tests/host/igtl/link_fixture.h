// SPDX-License-Identifier: Apache-2.0
// link_fixture.h - the viewer's OpenIGTLink in a thread of its own, and the library's client.
#pragma once

#include <gtest/gtest.h>
#include <igtlClientSocket.h>
#include <igtlTransformMessage.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "host/igtl/igtl_link.h"
#include "tests/support/message.h"

namespace tact::tests {

using boost::asio::ip::tcp;
using host::igtl::IgtlLink;
using host::igtl::IgtlOptions;
using host::tracking::BodyRole;
using host::tracking::BodyState;

class IgtlPeers : public testing::Test {
 protected:
  /// By its thread.
  template <typename Question>
  auto ask(const Question& question) {
    std::promise<decltype(question())> answer;
    auto future = answer.get_future();
    boost::asio::post(io_, [&] { answer.set_value(question()); });
    return future.get();
  }
  ~IgtlPeers() override {
    if (!thread_.joinable()) return;
    ask([this] { return link_.stop(), 0; });
    work_.reset();
    io_.stop();
    thread_.join();
  }
  /// The link in a thread of its own.
  std::string open(const IgtlOptions& options = {.port = 0}) {
    const std::string wrong = message_of(link_.open(options));
    if (!wrong.empty()) return wrong;
    link_.start();
    thread_ = std::thread([this] { io_.run(); });
    return {};
  }
  template <typename Condition>
  bool becomes(const Condition& condition) {
    for (int i = 0; i < 6000; ++i) {
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
    return ask([this] {
      std::string all;
      for (const std::string& message : said_) all += message + '\n';
      return all;
    });
  }
  host::tracking::TrackedBody head() {
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
    host::record::Frame frame;
    frame.tool_orientation[0] = 1.0f;
    frame.tool_position_m[1] = 0.125f;
    frame.force_N[2] = force_N;
    frame.state = state;
    ask([&] { return link_.add(frame), 0; });
  }

  boost::asio::io_context io_{1}, other_{1};
  std::vector<std::string> said_;
  IgtlLink link_{io_, [this](const std::string& message) { said_.push_back(message); }};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      io_.get_executor()};
  std::thread thread_;
};

inline std::string transform_of(const char* device, float x_mm) {
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

/// The next message of the library's client as `Message`, its checksum evaluated; the type is
/// reported.
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

}  // namespace tact::tests
