// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/service_manager.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace tact::firmware::console {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000'000;

std::string_view named_socket() {
  const char* path = std::getenv("NOTIFY_SOCKET");
  return path != nullptr ? path : "";
}

}  // namespace

bool is_service() { return !named_socket().empty(); }

ServiceManager::ServiceManager() {
  const std::string_view path = named_socket();
  // A path that is too long cannot be a socket: nothing is reported.
  if (path.empty() || path.size() >= sizeof address_.sun_path) return;
  address_.sun_family = AF_UNIX;
  std::memcpy(address_.sun_path, path.data(), path.size());
  if (path.front() == '@') address_.sun_path[0] = '\0';  // abstract socket, no file
  address_bytes_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

ServiceManager::~ServiceManager() {
  if (socket_ < 0) return;
  send("STOPPING=1\n");
  close(socket_);
}

void ServiceManager::report(const ServiceNews& news) {
  if (socket_ < 0) return;
  const bool first_ready = news.may_be_armed && !reported_ready_;
  // READY at once, because systemctl start waits for it; all else once a second.
  if (!first_ready && news.now_ns < next_ns_) return;
  std::string words = first_ready ? "READY=1\n" : "";
  if (news.ticks != ticks_) words += "WATCHDOG=1\n";
  reported_ready_ = reported_ready_ || news.may_be_armed;
  ticks_ = news.ticks;
  next_ns_ = news.now_ns + kPeriod_ns;
  send(words + "STATUS=" + news.status + "\n");
}

void ServiceManager::send(const std::string& words) const {
  [[maybe_unused]] const auto sent =  // a failed send is ignored
      sendto(socket_, words.data(), words.size(), MSG_NOSIGNAL,
             reinterpret_cast<const sockaddr*>(&address_), address_bytes_);
}

}  // namespace tact::firmware::console
