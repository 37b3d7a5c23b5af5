// SPDX-License-Identifier: Apache-2.0
// viewer_server.h - listens on one address and gives every browser a session.
//
// A random token guards what it shows (access.h). At most 64 connections at once: one more is
// answered with 503, and told.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "host/net/acceptor.h"
#include "host/server/http_session.h"
#include "model/result.h"

namespace tact::host::server {

struct ViewerOptions {
  std::string bind_address = "127.0.0.1";
  std::uint16_t port = 8321;  // 0: any free one
  std::string page_folder;
  std::string public_url{};  // where browsers find it, if not at bind_address and port
  std::chrono::milliseconds request_timeout{10'000};  // for one request to arrive
};

class ViewerServer {
 public:
  /// `warn` gets a message for the terminal.
  using Warn = std::function<void(const std::string& message)>;
  ViewerServer(boost::asio::io_context& io, LiveView& view, MoveHand move_hand, Warn warn = {});

  /// Loads the page and listens. Error: what is wrong and what to do.
  std::optional<model::Error> open(const ViewerOptions& options);
  /// Of a replay: what pages ask of it. Before start.
  void let_steer(Steer steer) { site_.steer = std::move(steer); }
  /// Where another scene may be asked for, and what is offered, as JSON. Before start.
  void let_choose(AskScene ask, std::string scenes) {
    site_.ask_scene = std::move(ask);
    site_.scenes = std::move(scenes);
  }
  void start();
  void stop();

  std::uint16_t port() const { return acceptor_.port(); }
  const std::string& token() const { return site_.access.token; }
  /// What a person opens in a browser; its fragment holds the token.
  std::string url() const;

 private:
  std::optional<model::Error> listen(const boost::asio::ip::tcp::endpoint& endpoint);
  void turn_away(boost::asio::ip::tcp::socket socket);

  net::Acceptor acceptor_;
  Site site_;
  Warn warn_;
  ConnectionSlot slot_;  // its copies are the connections
  std::uint64_t turned_away_ = 0;
  std::chrono::steady_clock::time_point reported_;
};

}  // namespace tact::host::server
