// SPDX-License-Identifier: Apache-2.0
// igtl_link.h - OpenIGTLink in the viewer: sends pose, force and status to clients, and receives
// poses of trackers, which move the operator's figure.
//
// It listens for clients (3D Slicer), and connects as a client to a server of trackers (PLUS), with
// retries. It sends nothing to that server. Runs in the viewer's one thread. No force depends on
// it.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/igtl/igtl_bodies.h"
#include "host/igtl/igtl_frame.h"
#include "host/igtl/igtl_session.h"
#include "host/net/acceptor.h"
#include "model/result.h"

namespace tact::host::igtl {

struct IgtlOptions {
  std::optional<std::uint16_t> port{};  // 0: any free one; none: no listening
  std::string bind_address = "127.0.0.1";
  std::string from{};  // ADDRESS:PORT of a server of trackers; empty: none

  bool is_asked_for() const { return port.has_value() || !from.empty(); }
};

inline constexpr std::size_t kMaxClients = 8;
inline constexpr std::chrono::milliseconds kFrameGap{30}, kStatusGap{1000};

class IgtlLink {
 public:
  using Say = std::function<void(const std::string& message)>;

  IgtlLink(boost::asio::io_context& io, Say say);
  ~IgtlLink();
  IgtlLink(const IgtlLink&) = delete;
  IgtlLink& operator=(const IgtlLink&) = delete;

  /// Listens. The error states the cause and the remedy.
  std::optional<model::Error> open(const IgtlOptions& options);
  void start();
  void stop();

  /// Sends to all clients, at most once per kFrameGap; the status at a change and per kStatusGap.
  void add(const record::Frame& frame);
  /// Call when tactd has gone or is silent.
  void lose();

  /// The bodies that trackers have sent, at present.
  tracking::TrackedOperator now() const;

  std::uint16_t port() const { return acceptor_.port(); }
  std::size_t clients() const { return clients_.size(); }
  std::uint64_t refused() const { return refused_; }  // messages

 private:
  using Session = std::shared_ptr<IgtlSession>;
  std::optional<model::Error> listen(const IgtlOptions& options);
  void welcome(boost::asio::ip::tcp::socket socket);
  void go_to_server();
  void come_back();
  SessionEvents events_of(std::function<void(const std::string& reason)> ended);
  void take(const MessageHead& head, const pose::Pose& pose);
  void refuse(const std::string& message);
  void report(const Status& status, const std::string& before);
  double now_s() const;

  boost::asio::io_context& io_;
  net::Acceptor acceptor_;
  boost::asio::steady_timer retry_;
  Say say_;
  std::chrono::steady_clock::time_point began_, sent_, reported_;
  std::optional<boost::asio::ip::tcp::endpoint> server_;
  std::string server_name_;
  std::unique_ptr<boost::asio::ip::tcp::socket> calling_;
  Session tracker_;
  std::vector<Session> clients_;  // oldest first
  IgtlBodies bodies_;
  Status last_ = lost_status();
  std::uint64_t refused_ = 0;
  std::set<std::string> troubles_;  // already reported
  bool reported_strange_ = false, reported_away_ = false;
};

}  // namespace tact::host::igtl
