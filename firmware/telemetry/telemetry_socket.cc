// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/telemetry_socket.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "firmware/protocol/run_file.h"

namespace tact::firmware::telemetry {
namespace {

using model::Error;
using model::Result;

// As many may connect between two frames.
constexpr int kQueue = 64;

}  // namespace

Result<TelemetrySocket> TelemetrySocket::open(const std::string& path, int start_fd,
                                              std::optional<gid_t> viewers) {
  // From the first moment only this user can connect; the group is admitted last.
  const auto bound = model::io::bind_socket(path, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (!bound) return bound.error();
  const int fd = *bound;
  if (listen(fd, kQueue) != 0) {
    Error error{fmt::format("{}: {}; choose another --socket", path, std::strerror(errno))};
    close(fd);
    return error;
  }
  // Owns the file from here on: an error below removes it.
  TelemetrySocket opened(model::io::SocketFile(path), fd, start_fd,
                         {.user = std::nullopt, .group = viewers});
  if (viewers)
    if (auto refused = model::io::share_socket(path, *viewers)) return std::move(*refused);
  return opened;
}

TelemetrySocket::TelemetrySocket(TelemetrySocket&& other) noexcept
    : file_(std::move(other.file_)),
      listen_fd_(std::exchange(other.listen_fd_, -1)),
      start_fd_(std::exchange(other.start_fd_, -1)),
      trust_(other.trust_),
      clients_(std::move(other.clients_)),
      dropped_frames_(other.dropped_frames_) {}

TelemetrySocket::~TelemetrySocket() {
  for (const int client : clients_) close(client);
  if (start_fd_ >= 0) close(start_fd_);
  if (listen_fd_ < 0) return;
  close(listen_fd_);
  file_.remove();
}

void TelemetrySocket::accept_clients() {
  for (int i = 0; i < kQueue; ++i) {
    const int client = accept4(listen_fd_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (client < 0) return;
    shutdown(client, SHUT_RD);  // nothing is read from a client
    // The peer's user is checked before anything is sent.
    const bool is_trusted = model::io::has_trusted_peer(client, trust_);
    const bool is_full = clients_.size() == kMaxClients;
    if (is_trusted && !is_full && greet(client)) {
      clients_.push_back(client);
      continue;
    }
    if (is_trusted && is_full)
      static_cast<void>(::send(client, protocol::kFull.data(), protocol::kFull.size(),
                               MSG_DONTWAIT | MSG_NOSIGNAL));
    close(client);
  }
}

bool TelemetrySocket::greet(int client_fd) const {
  std::string magic(protocol::kMagic);  // msghdr takes no pointer to const
  iovec bytes{.iov_base = magic.data(), .iov_len = magic.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &bytes;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  cmsghdr* rights = CMSG_FIRSTHDR(&message);
  rights->cmsg_level = SOL_SOCKET;
  // Head and meshes are megabytes, so they are passed as a descriptor.
  rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(sizeof(int));
  std::memcpy(CMSG_DATA(rights), &start_fd_, sizeof start_fd_);
  return sendmsg(client_fd, &message, MSG_DONTWAIT | MSG_NOSIGNAL) ==
         static_cast<ssize_t>(magic.size());
}

void TelemetrySocket::send(const std::string& message) {
  accept_clients();
  const auto gone = [&](int client) {
    if (::send(client, message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL) ==
        static_cast<ssize_t>(message.size()))
      return false;
    // A slow viewer loses this frame; a viewer that has gone is removed.
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS) {
      ++dropped_frames_;
      return false;
    }
    close(client);
    return true;
  };
  clients_.erase(std::remove_if(clients_.begin(), clients_.end(), gone), clients_.end());
}

}  // namespace tact::firmware::telemetry
