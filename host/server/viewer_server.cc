// SPDX-License-Identifier: Apache-2.0
#include "host/server/viewer_server.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace tact::host::server {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;
using model::Error;
using model::Result;

constexpr std::chrono::seconds kReportAgain{10};
constexpr std::size_t kMaxWarned = 32;  // texts that are not printed again

/// An address as in a URL. The unspecified address becomes the machine's name.
std::string url_name(const boost::asio::ip::address& address) {
  if (address.is_unspecified()) {
    char name[256] = {};
    if (gethostname(name, sizeof name - 1) == 0) return name;
  }
  return address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
}

}  // namespace

ViewerServer::ViewerServer(boost::asio::io_context& io, LiveView& view, MoveHand move_hand,
                           Warn warn)
    : acceptor_(io),
      site_{.view = view,
            .page = {},
            .access = {},
            .take_slot = [this] { return take_slot(); },
            .move_hand = std::move(move_hand),
            .steer = {},
            .ask_scene = {},
            .take_digit = {},
            .warn_once = [this](const std::string& text) { warn_once(text); },
            .scenes = {},
            .request_timeout = {}},
      warn_(std::move(warn)),
      slot_(std::make_shared<char>()) {}

std::optional<Error> ViewerServer::open(const ViewerOptions& options) {
  error_code wrong;
  const auto address = boost::asio::ip::make_address(options.bind_address, wrong);
  if (wrong) {
    return Error{
        fmt::format("--bind {}: not an IP address; use 127.0.0.1 for this PC only or 0.0.0.0 "
                    "for the network",
                    options.bind_address)};
  }
  if (!options.public_url.empty() && authority_of(options.public_url).empty()) {
    return Error{
        fmt::format("--url {}: not the address of a proxy; write it as https://name:port/, "
                    "without a path",
                    options.public_url)};
  }
  // The page first: without it the server would only answer 404.
  if (std::optional<Error> error = site_.page.load(options.page_folder)) return error;
  if (std::optional<Error> error = listen({address, options.port})) return error;
  site_.request_timeout = options.request_timeout;
  site_.access.loopback = address.is_loopback();
  site_.access.bind_address = url_name(address);
  site_.access.public_url = options.public_url;
  Result<std::string> made = make_token();
  if (!made) return made.error();
  site_.access.token = std::move(*made);
  return std::nullopt;
}

std::optional<Error> ViewerServer::listen(const tcp::endpoint& endpoint) {
  const error_code wrong = acceptor_.listen(endpoint);
  if (!wrong) return std::nullopt;
  if (wrong == boost::asio::error::address_in_use) {
    return Error{
        fmt::format("port {} is in use; stop the other program or give --port another number",
                    endpoint.port())};
  }
  return Error{fmt::format("cannot listen on {} port {}: {}; choose another --bind or --port",
                           endpoint.address().to_string(), endpoint.port(), wrong.message())};
}

void ViewerServer::start() {
  acceptor_.start([this](tcp::socket socket) {
    std::erase_if(unauthenticated_, [](const auto& one) {
      const auto session = one.lock();
      return !session || session->has_slot();
    });
    if (unauthenticated_.size() == kMaxUnauthenticated) {
      unauthenticated_.front().lock()->stop();
      unauthenticated_.pop_front();
    }
    const auto session =
        std::make_shared<HttpSession>(boost::beast::tcp_stream(std::move(socket)), site_);
    unauthenticated_.push_back(session);
    session->start();
  });
}

ConnectionSlot ViewerServer::take_slot() {
  // One use is the server's own.
  if (slot_.use_count() <= kMaxConnections) return slot_;
  ++turned_away_;
  const auto now = std::chrono::steady_clock::now();
  if (!warn_ || (turned_away_ > 1 && now - reported_ < kReportAgain)) return nullptr;
  reported_ = now;
  warn_(
      fmt::format("{} pages and downloads are open, no more are let in ({} turned away so far); "
                  "close some",
                  kMaxConnections, turned_away_));
  return nullptr;
}

/// A page that tries again every second says the same every second.
void ViewerServer::warn_once(const std::string& text) {
  if (!warn_ || std::ranges::find(warned_, text) != warned_.end()) return;
  if (warned_.size() == kMaxWarned) warned_.pop_front();
  warned_.push_back(text);
  warn_(text);
}

void ViewerServer::stop() { acceptor_.stop(); }

std::string ViewerServer::url() const {
  std::string at = site_.access.public_url;
  if (at.empty()) at = fmt::format("http://{}:{}/", site_.access.bind_address, port());
  return fmt::format("{}{}#token={}", at, at.ends_with('/') ? "" : "/", token());
}

}  // namespace tact::host::server
