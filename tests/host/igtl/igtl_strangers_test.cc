// SPDX-License-Identifier: Apache-2.0
// The viewer's link against what no client sends, and clients that do not read.
#include <gtest/gtest.h>
#include <igtlStatusMessage.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <fstream>

#include "host/igtl/igtl_link.h"
#include "tests/host/igtl/link_fixture.h"

namespace tact::host::igtl::igtl_strangers_test {

using boost::asio::ip::tcp;
using tests::Received;
using tests::transform_of;
using tracking::BodyRole;
using tracking::BodyState;

using LinkAndStrangers = tests::IgtlPeers;

TEST_F(LinkAndStrangers, ADamagedMessageIsLeftOutAndTheNextIsTaken) {
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
  for (const char* kind : {"its checksum is not that of its bytes", "the size is wrong"})
    EXPECT_NE(said().find(kind), std::string::npos)
        << "the first of each kind is reported: " << said();
  EXPECT_EQ(clients(), 1u);
}

TEST_F(LinkAndStrangers, AHugeLengthOrNoHeaderEndsTheConnection) {
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

constexpr std::size_t kBatch_B = 360;  // two transforms, a force, a status: about

/// Batches that the kernel keeps for one connection that is not read.
int batches_kept() {
  std::ifstream limits("/proc/sys/net/ipv4/tcp_wmem");
  std::size_t least = 0, first = 0, most = 0;
  limits >> least >> first >> most;
  EXPECT_GT(most, 0U);
  return static_cast<int>((most + 500'000) / kBatch_B);
}

TEST_F(LinkAndStrangers, AClientThatDoesNotReadDelaysNone) {
  ASSERT_EQ(open(), "");
  tcp::socket lazy(other_, tcp::v4());
  lazy.set_option(boost::asio::socket_base::receive_buffer_size(65'536));
  lazy.connect({boost::asio::ip::address_v4::loopback(), link_.port()});
  auto socket = client();
  ASSERT_TRUE(becomes([this] { return link_.clients() == 2; }));
  record::Frame frame;
  frame.tool_orientation[0] = 1.0f;
  // A status that changes each time is sent each time: more than the kernel keeps, by about two
  // megabytes, as the link ends a connection that takes nothing for 10 s.
  const int most = batches_kept() + 3000;
  for (int i = 0; i < most; ++i) {
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
  // What the kernel kept for the other, then the newest: nothing else was kept.
  std::string kept;
  while (kept.find("ready") == std::string::npos) {
    char part[65'536];
    kept.append(part, lazy.read_some(boost::asio::buffer(part)));
  }
  EXPECT_LT(kept.size(), static_cast<std::size_t>(most - 1000) * kBatch_B);
}

TEST_F(LinkAndStrangers, NinthClientReplacesTheOldestSilentOne) {
  ASSERT_EQ(open(), "");
  std::vector<tcp::socket> sockets;
  for (std::size_t i = 0; i < kMaxClients; ++i) sockets.push_back(raw_client());
  ASSERT_TRUE(becomes([this] { return link_.clients() == kMaxClients; }));
  const tcp::socket ninth = raw_client();
  boost::system::error_code wrong;
  std::array<char, 4096> some{};
  while (!wrong) sockets.front().read_some(boost::asio::buffer(some), wrong);
  EXPECT_TRUE(becomes([this] { return link_.clients() == kMaxClients; }))
      << "the oldest is closed before the ninth is counted";
  sockets.pop_back();
  EXPECT_TRUE(becomes([this] { return link_.clients() == kMaxClients - 1; }));
}

// A pulled cable sends nothing: only the kernel's own questions find it.
TEST(IgtlSession, KeepaliveEndsTheConnectionOfAVanishedPeer) {
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket socket(io, boost::asio::ip::tcp::v4());
  notice_vanishing(socket);
  const auto option = [&](int level, int name) {
    int value = 0;
    socklen_t size = sizeof value;
    EXPECT_EQ(getsockopt(socket.native_handle(), level, name, &value, &size), 0);
    return value;
  };
  EXPECT_EQ(option(SOL_SOCKET, SO_KEEPALIVE), 1);
  EXPECT_EQ(option(IPPROTO_TCP, TCP_KEEPIDLE) +
                option(IPPROTO_TCP, TCP_KEEPINTVL) * option(IPPROTO_TCP, TCP_KEEPCNT),
            kVanished.count());
}

}  // namespace tact::host::igtl::igtl_strangers_test
