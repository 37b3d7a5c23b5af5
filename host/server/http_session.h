// SPDX-License-Identifier: Apache-2.0
// http_session.h - one HTTP connection: page files, scene, meshes, downloads, the upgrade to the
// WebSocket, and in a header what a page reports of itself. Read-only: GET and HEAD. A malformed
// or oversized request gets an error and the connection is closed; one that is too slow is closed
// without an answer.
#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "host/server/access.h"
#include "host/server/connection_slot.h"
#include "host/server/live_session.h"
#include "host/server/live_view.h"
#include "host/server/page_files.h"

namespace tact::host::server {

/// Shared by all connections.
struct Site {
  LiveView& view;
  PageFiles page;
  Access access;
  std::function<ConnectionSlot()> take_slot;  // null: all are taken
  MoveHand move_hand;
  Steer steer;           // only of a replay
  AskScene ask_scene;    // only of a simulation that offers scenes
  TakeDigit take_digit;  // only for a program that asks for answers
  std::function<void(const std::string& text)> warn_once;  // a line on the terminal
  std::string scenes;                                      // the offered scenes, as JSON; or empty
  std::chrono::milliseconds request_timeout;  // for one whole request, after the last response
};

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  using Request = LiveSession::Request;
  using Response = boost::beast::http::response<boost::beast::http::string_body>;

  HttpSession(boost::beast::tcp_stream stream, Site& site);
  void start() { read_next(); }
  /// It has shown the token.
  bool has_slot() const { return slot_ != nullptr; }
  /// Closes the connection.
  void stop() { stream_.close(); }

 private:
  void read_next();
  void refuse(boost::system::error_code wrong);
  void handle(const Request& request);
  bool from_own_page(const Request& request, std::string_view origin);
  void turn_away(boost::beast::http::status status, const std::string& reason,
                 const Request& request);
  void upgrade(const Request& request);
  void download(const Request& request, std::string_view path, std::string_view query);
  Response answer(const Request& request, std::string_view path) const;
  void write(Response response, const Request& request);
  void send();
  void leave();
  void drain();

  boost::beast::tcp_stream stream_;
  ConnectionSlot slot_;
  boost::beast::flat_buffer in_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  Response response_;
  std::size_t drained_bytes_ = 0;
  Site& site_;
};

}  // namespace tact::host::server
