// SPDX-License-Identifier: Apache-2.0
#include "host/igtl/igtl_link.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace tact::host::igtl {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;
using model::Error;
using model::Result;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kRetry{1000};
// Peers choose the names in these messages: without a bound they would fill memory and terminal.
constexpr std::size_t kMaxTroubles = 16;  // reported separately

double utc_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

Result<tcp::endpoint> endpoint_of(const std::string& text) {
  // The last colon, because an IPv6 address has others, in its brackets.
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
  std::uint16_t number = 0;
  const auto [end, wrong_port] = std::from_chars(port.data(), port.data() + port.size(), number);
  std::string name = text.substr(0, colon);
  if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
  error_code wrong;
  const auto address = boost::asio::ip::make_address(name, wrong);
  if (wrong || wrong_port != std::errc() || end != port.data() + port.size() || number == 0)
    return Error{fmt::format(
        "--igtl-from {}: not an IP address and a port; write it as 127.0.0.1:18944", text)};
  return tcp::endpoint{address, number};
}

}  // namespace

IgtlLink::IgtlLink(boost::asio::io_context& io, Say say)
    : io_(io),
      acceptor_(io),
      retry_(io),
      say_(std::move(say)),
      began_(Clock::now()),
      sent_(began_ - kFrameGap),
      reported_(began_ - kStatusGap) {}

IgtlLink::~IgtlLink() { stop(); }

double IgtlLink::now_s() const {
  return std::chrono::duration<double>(Clock::now() - began_).count();
}

std::optional<Error> IgtlLink::open(const IgtlOptions& options) {
  if (!options.from.empty()) {
    const Result<tcp::endpoint> server = endpoint_of(options.from);
    if (!server) return server.error();
    server_ = *server;
    server_name_ = options.from;
  }
  return options.port ? listen(options) : std::nullopt;
}

std::optional<Error> IgtlLink::listen(const IgtlOptions& options) {
  error_code wrong;
  const auto address = boost::asio::ip::make_address(options.bind_address, wrong);
  if (wrong) {
    return Error{fmt::format(
        "--igtl-bind {}: not an IP address; use 127.0.0.1 for this PC only or 0.0.0.0 for the "
        "network",
        options.bind_address)};
  }
  wrong = acceptor_.listen({address, *options.port});
  if (wrong) {
    return Error{
        fmt::format("OpenIGTLink cannot listen on {} port {}: {}; choose another "
                    "--igtl-bind or --igtl",
                    options.bind_address, *options.port, wrong.message())};
  }
  if (!address.is_loopback()) {
    say_(fmt::format(
        "OpenIGTLink on {}: each client that reaches port {} sees pose and force, and can move "
        "the operator's figure; there is no password",
        options.bind_address, port()));
  }
  return std::nullopt;
}

void IgtlLink::start() {
  if (acceptor_.is_listening())
    acceptor_.start([this](tcp::socket socket) { welcome(std::move(socket)); });
  if (server_) go_to_server();
}

void IgtlLink::stop() {
  error_code ignored;
  acceptor_.stop();
  retry_.cancel(ignored);
  if (calling_) calling_->close(ignored);
  if (tracker_) tracker_->stop();
  // stop() reports no event, so no session is erased from the set during this loop.
  for (const Session& client : clients_) client->stop();
  clients_.clear();
}

void IgtlLink::welcome(tcp::socket socket) {
  if (clients_.size() >= kMaxClients) {
    refuse("more than 8 programs have come; one is sent away");
    // The one that has been silent longest makes room, so that silent clients lock none out.
    const auto silent =
        std::ranges::find_if(clients_, [](const Session& one) { return !one->has_spoken(); });
    if (silent == clients_.end()) return;
    (*silent)->stop();
    clients_.erase(silent);
  }
  // A strong pointer here would be a cycle: the session owns its events.
  auto place = std::make_shared<std::weak_ptr<IgtlSession>>();
  const auto session = std::make_shared<IgtlSession>(
      std::move(socket), events_of([this, place](const std::string& reason) {
        if (!reason.empty()) refuse(reason + "; it is let go");
        if (const Session gone = place->lock()) std::erase(clients_, gone);
      }));
  *place = session;
  clients_.push_back(session);
  session->start();
  // At once, so that the client need not wait a second for the status.
  session->send(igtl::status("Tact", utc_s(), last_));
}

void IgtlLink::go_to_server() {
  calling_ = std::make_unique<tcp::socket>(io_);
  error_code ignored;
  calling_->open(server_->protocol(), ignored);
  // The kernel's default of six would keep trying a dead address for two minutes.
  constexpr int kSyns = 2;  // some 7 s, where nothing answers
  static_cast<void>(
      setsockopt(calling_->native_handle(), IPPROTO_TCP, TCP_SYNCNT, &kSyns, sizeof kSyns));
  calling_->async_connect(*server_, [this](error_code wrong) {
    if (wrong == boost::asio::error::operation_aborted) return;
    if (wrong) {
      // Reported once per loss, not each second.
      if (!std::exchange(reported_away_, true))
        say_(fmt::format("OpenIGTLink: no server at {} ({}); asked again each second", server_name_,
                         wrong.message()));
      return come_back();
    }
    reported_away_ = false;
    tracker_ = std::make_shared<IgtlSession>(
        std::move(*calling_), events_of([this](const std::string& reason) {
          say_(fmt::format("OpenIGTLink: {} has gone{}{}", server_name_, reason.empty() ? "" : ": ",
                           reason));
          tracker_.reset();
          come_back();
        }));
    tracker_->start();
  });
}

void IgtlLink::come_back() {
  retry_.expires_after(kRetry);
  retry_.async_wait([this](error_code cancelled) {
    if (!cancelled) go_to_server();
  });
}

SessionEvents IgtlLink::events_of(std::function<void(const std::string& reason)> ended) {
  return {.pose = [this](const MessageHead& head, const pose::Pose& pose) { take(head, pose); },
          .refused = [this](const std::string& message) { refuse(message); },
          .ended = std::move(ended)};
}

void IgtlLink::take(const MessageHead& head, const pose::Pose& pose) {
  const auto role = role_of(head.device);
  if (role) return bodies_.take(*role, pose, head.time_s, now_s());
  if (!std::exchange(reported_strange_, true))
    say_(
        fmt::format("OpenIGTLink: \"{}\" is no body of the operator; it is left out, and others "
                    "whose name is that of no role",
                    head.device));
}

void IgtlLink::refuse(const std::string& message) {
  ++refused_;
  if (troubles_.size() < kMaxTroubles && troubles_.insert(message).second)
    say_(fmt::format("OpenIGTLink: {}; others like it are only counted", message));
}

void IgtlLink::add(const record::Frame& frame) {
  const Clock::time_point now = Clock::now();
  const Status status = status_of(frame);
  const bool is_due = now - sent_ >= kFrameGap;
  const bool reports = status != last_ || now - reported_ >= kStatusGap;
  // Messages are made only if there is a client.
  if (clients_.empty() || (!is_due && !reports)) return;
  sent_ = now;
  const std::string messages = frame_messages(frame, utc_s());
  if (reports) return report(status, messages);
  for (const Session& client : clients_) client->send(messages);
}

void IgtlLink::lose() { report(lost_status(), {}); }

void IgtlLink::report(const Status& status, const std::string& before) {
  last_ = status;
  reported_ = Clock::now();
  const std::string batch = before + igtl::status("Tact", utc_s(), status);
  for (const Session& client : clients_) client->send(batch);
}

tracking::TrackedOperator IgtlLink::now() const { return bodies_.at(now_s()); }

}  // namespace tact::host::igtl
