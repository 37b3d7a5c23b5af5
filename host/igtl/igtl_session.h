// SPDX-License-Identifier: Apache-2.0
// igtl_session.h - one OpenIGTLink connection: receives and checks messages, sends without waiting.
//
// Receiving: a message of another type is read and discarded, up to kMaxSkippedBody. A damaged
// message of a used type is ignored, and the connection is kept. Bytes that are no header, or an
// excessive length, close it. Sending: while one batch is sent, the next waits, and a newer one
// replaces it; a slow client thus skips batches and costs no memory. A client that reads nothing
// for kTimeout is disconnected.
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
inline constexpr std::uint64_t kMaxSkippedBody = 256u << 20;  // of one that is discarded
inline constexpr std::chrono::seconds kTimeout{10};

struct SessionEvents {
  std::function<void(const MessageHead& head, const pose::Pose& pose)> pose;
  /// A message was ignored; the connection is kept.
  std::function<void(const std::string& message)> refused;
  /// Once. Empty reason: the peer closed the connection.
  std::function<void(const std::string& reason)> ended;
};

/// Sets TCP keepalive: a peer that vanished without closing (a pulled cable, a power cut) ends the
/// connection after kVanished.
void notice_vanishing(boost::asio::ip::tcp::socket& socket);
inline constexpr std::chrono::seconds kVanished{11};

class IgtlSession : public std::enable_shared_from_this<IgtlSession> {
 public:
  IgtlSession(boost::asio::ip::tcp::socket socket, SessionEvents events);

  void start();
  void send(const std::string& batch);
  void stop();
  /// It has sent a message whose checksum is good.
  bool has_spoken() const { return has_spoken_; }

 private:
  using Code = boost::system::error_code;
  void read_head_next();
  void read_body(std::size_t bytes);
  void read_away(std::uint64_t bytes);
  void take_body(std::string_view body);
  void write_next();
  void end(const std::string& reason);
  /// After a failed read: the peer closed, or the reason.
  void end(const Code& wrong);

  boost::asio::ip::tcp::socket socket_;
  boost::asio::steady_timer timeout_;
  SessionEvents events_;
  MessageHead head_;
  std::array<char, kMaxUsedBody> bytes_{};
  std::string on_its_way_, waiting_;
  bool ended_ = false, has_spoken_ = false;
};

}  // namespace tact::host::igtl
