// SPDX-License-Identifier: Apache-2.0
// acceptor.h - listens on one TCP endpoint and hands over each connection, also after a shortage of
// file descriptors.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>

namespace tact::host::net {

class Acceptor {
 public:
  using Arrived = std::function<void(boost::asio::ip::tcp::socket socket)>;

  explicit Acceptor(boost::asio::io_context& io) : io_(io), acceptor_(io), pause_(io) {}

  /// Opens, binds and listens; port 0 takes any free one.
  boost::system::error_code listen(const boost::asio::ip::tcp::endpoint& endpoint);
  bool is_listening() const { return acceptor_.is_open(); }
  std::uint16_t port() const;

  /// Calls `arrived` for every connection, until stop().
  void start(Arrived arrived);
  void stop();

 private:
  void accept_next();

  boost::asio::io_context& io_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  Arrived arrived_;
};

}  // namespace tact::host::net
