// SPDX-License-Identifier: Apache-2.0
// viewer_server.h - listens on one address and starts a session for every browser.
//
// A random token protects the data (access.h). At most 64 connections at once: a further one is
// answered with 503 and reported.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "host/net/acceptor.h"
#include "host/server/http_session.h"
#include "model/result.h"

namespace tact::host::server {

struct ViewerOptions {
  std::string bind_address = "127.0.0.1";
  std::uint16_t port = 8321;  // 0: any free port
  std::string page_folder;
  std::string public_url{};  // address for browsers, if not bind_address and port
  std::chrono::milliseconds request_timeout{10'000};  // for one request to arrive
};

class ViewerServer {
 public:
  /// `warn` prints a message on the terminal.
  using Warn = std::function<void(const std::string& message)>;
  ViewerServer(boost::asio::io_context& io, LiveView& view, MoveHand move_hand, Warn warn = {});

  /// Loads the page and listens. The error states the cause and the remedy.
  std::optional<model::Error> open(const ViewerOptions& options);
  /// In a replay: takes the requests of pages. Call before start.
  void let_steer(Steer steer) { site_.steer = std::move(steer); }
  /// Takes the digits that a person types at a page. Call before start.
  void let_answer(TakeDigit take) { site_.take_digit = std::move(take); }
  /// Enables requests for another scene; `scenes`: the offered ones, as JSON. Call before start.
  void let_choose(AskScene ask, std::string scenes) {
    site_.ask_scene = std::move(ask);
    site_.scenes = std::move(scenes);
  }
  void start();
  void stop();

  std::uint16_t port() const { return acceptor_.port(); }
  const std::string& token() const { return site_.access.token; }
  /// The link to open in a browser; its fragment holds the token.
  std::string url() const;

 private:
  std::optional<model::Error> listen(const boost::asio::ip::tcp::endpoint& endpoint);
  ConnectionSlot take_slot();
  void warn_once(const std::string& text);

  net::Acceptor acceptor_;
  Site site_;
  Warn warn_;
  ConnectionSlot slot_;  // its copies are the connections that have shown the token
  std::deque<std::weak_ptr<HttpSession>> unauthenticated_;  // the others, oldest first
  std::deque<std::string> warned_;                          // the last texts of warn_once
  std::uint64_t turned_away_ = 0;
  std::chrono::steady_clock::time_point reported_;
};

}  // namespace tact::host::server
