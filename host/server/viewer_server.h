// SPDX-License-Identifier: Apache-2.0
// viewer_server.h - listens on one address and gives every browser a session.
//
// On loopback it is open to this machine; on any other address a random token guards it (access.h).
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <optional>
#include <string>

#include "host/server/http_session.h"
#include "model/result.h"

namespace tact::host::server {

struct ViewerOptions {
  std::string bind_address = "127.0.0.1";
  std::uint16_t port = 8321;  // 0: any free one
  std::string page_folder;
};

class ViewerServer {
 public:
  ViewerServer(boost::asio::io_context& io, LiveView& view, MoveHand move_hand);

  /// Loads the page and listens. Error: what is wrong and what to do.
  std::optional<model::Error> open(const ViewerOptions& options);
  void start() { accept_next(); }
  void stop();

  std::uint16_t port() const { return port_; }
  const std::string& token() const { return site_.access.token; }
  /// What a person types into a browser.
  std::string url() const;

 private:
  std::optional<model::Error> listen(const boost::asio::ip::tcp::endpoint& endpoint);
  void accept_next();

  boost::asio::io_context& io_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  Site site_;
  std::uint16_t port_ = 0;
};

}  // namespace tact::host::server
