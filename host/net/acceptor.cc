// SPDX-License-Identifier: Apache-2.0
#include "host/net/acceptor.h"

#include <chrono>
#include <utility>

namespace tact::host::net {

using boost::asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kPauseAfterError{200};

}  // namespace

error_code Acceptor::listen(const tcp::endpoint& endpoint) {
  error_code wrong;
  acceptor_.open(endpoint.protocol(), wrong);
  if (!wrong) acceptor_.set_option(tcp::acceptor::reuse_address(true), wrong);
  if (!wrong) acceptor_.bind(endpoint, wrong);
  if (!wrong) acceptor_.listen(boost::asio::socket_base::max_listen_connections, wrong);
  return wrong;
}

std::uint16_t Acceptor::port() const {
  error_code ignored;
  return acceptor_.local_endpoint(ignored).port();
}

void Acceptor::start(Arrived arrived) {
  arrived_ = std::move(arrived);
  accept_next();
}

void Acceptor::stop() {
  error_code ignored;
  acceptor_.close(ignored);
  pause_.cancel(ignored);
}

void Acceptor::accept_next() {
  acceptor_.async_accept(io_, [this](error_code wrong, tcp::socket socket) {
    if (wrong == boost::asio::error::operation_aborted) return;
    if (!wrong) {
      arrived_(std::move(socket));
      return accept_next();
    }
    // For example without a free descriptor: pause before the next try instead of spinning.
    pause_.expires_after(kPauseAfterError);
    pause_.async_wait([this](error_code cancelled) {
      if (!cancelled) accept_next();
    });
  });
}

}  // namespace tact::host::net
