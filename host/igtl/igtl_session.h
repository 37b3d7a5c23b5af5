// SPDX-License-Identifier: Apache-2.0
// igtl_session.h - one OpenIGTLink connection: messages in, judged; messages out, never waiting.
//
// In: a message that is not asked for is read away unkept, up to kMaxSkippedBody. One that is and
// is damaged is left out; the connection goes on. Bytes that are no header, or a length that
// nothing has, end it. Out: while one batch is on its way the next waits, and a newer one takes
// its place: a slow client skips batches and costs no memory. One that reads nothing for
// kTimeout is disconnected.
#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "host/igtl/igtl_wire.h"

namespace tact::host::igtl {

inline constexpr std::size_t kMaxUsedBody = 4096;             // of a message that is used
inline constexpr std::uint64_t kMaxSkippedBody = 256u << 20;  // of one that is read away, an image
inline constexpr std::chrono::seconds kTimeout{10};

struct SessionEvents {
  std::function<void(const MessageHead& head, const pose::Pose& pose)> pose;
  /// What was left out; the connection goes on.
  std::function<void(const std::string& message)> refused;
  /// Once. Empty: the other side went.
  std::function<void(const std::string& reason)> ended;
};

/// The kernel asks a peer that is silent whether it is still there; one that vanished without a
/// word (a pulled cable, a power cut) ends the connection after kVanished.
void notice_vanishing(boost::asio::ip::tcp::socket& socket);
inline constexpr std::chrono::seconds kVanished{11};

class IgtlSession : public std::enable_shared_from_this<IgtlSession> {
 public:
  IgtlSession(boost::asio::ip::tcp::socket socket, SessionEvents events);

  void start();
  void send(const std::string& batch);
  void stop();

 private:
  using Code = boost::system::error_code;
  void read_head_next();
  void read_body(std::size_t bytes);
  void read_away(std::uint64_t bytes);
  void take_body(std::string_view body);
  void write_next();
  void end(const std::string& reason);
  /// Of a read that failed: the other side went, or why.
  void end(const Code& wrong);

  boost::asio::ip::tcp::socket socket_;
  boost::asio::steady_timer timeout_;
  SessionEvents events_;
  MessageHead head_;
  std::array<char, kMaxUsedBody> bytes_{};
  std::string on_its_way_, waiting_;
  bool ended_ = false;
};

}  // namespace tact::host::igtl
