// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/telemetry_socket.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace tact::firmware::telemetry {
namespace {

using model::Error;
using model::Result;

// Chosen: each costs a call a frame. More wait in the queue of the socket.
constexpr std::size_t kMaxClients = 16;

}  // namespace

Result<TelemetrySocket> TelemetrySocket::open(const std::string& path, const Hello& hello,
                                              int mesh_fd, std::optional<gid_t> viewers) {
  // Nobody but this user can connect from the first moment; the group is let in last.
  const auto bound = model::io::bind_socket(path, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (!bound) return bound.error();
  const int fd = *bound;
  if (listen(fd, 8) != 0) {
    Error error{fmt::format("{}: {}; choose another --socket", path, std::strerror(errno))};
    close(fd);
    return error;
  }
  // Owner of the file from here on: an error below removes it.
  TelemetrySocket opened(model::io::SocketFile(path), hello, fd, mesh_fd,
                         {.user = std::nullopt, .group = viewers});
  if (viewers)
    if (auto refused = model::io::share_socket(path, *viewers)) return std::move(*refused);
  return opened;
}

TelemetrySocket::TelemetrySocket(TelemetrySocket&& other) noexcept
    : file_(std::move(other.file_)),
      hello_(other.hello_),
      listen_fd_(std::exchange(other.listen_fd_, -1)),
      mesh_fd_(std::exchange(other.mesh_fd_, -1)),
      trust_(other.trust_),
      clients_(std::move(other.clients_)),
      dropped_frames_(other.dropped_frames_) {}

TelemetrySocket::~TelemetrySocket() {
  for (const int client : clients_) close(client);
  if (mesh_fd_ >= 0) close(mesh_fd_);
  if (listen_fd_ < 0) return;
  close(listen_fd_);
  file_.remove();
}

void TelemetrySocket::accept_clients() {
  while (clients_.size() < kMaxClients) {
    const int client = accept4(listen_fd_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (client < 0) return;
    shutdown(client, SHUT_RD);  // whatever it says is not listened to
    // Who is at the other end is asked before it gets anything.
    if (model::io::has_trusted_peer(client, trust_) && greet(client))
      clients_.push_back(client);
    else
      close(client);
  }
}

bool TelemetrySocket::greet(int client_fd) const {
  // sendmsg takes no const.
  Hello hello = hello_;
  iovec bytes{.iov_base = &hello, .iov_len = sizeof hello};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &bytes;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  cmsghdr* rights = CMSG_FIRSTHDR(&message);
  rights->cmsg_level = SOL_SOCKET;
  // The meshes go as a descriptor: megabytes that no message has to carry.
  rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(sizeof(int));
  std::memcpy(CMSG_DATA(rights), &mesh_fd_, sizeof mesh_fd_);
  return sendmsg(client_fd, &message, MSG_DONTWAIT | MSG_NOSIGNAL) == sizeof hello;
}

void TelemetrySocket::send(const Frame& frame) {
  accept_clients();
  const auto gone = [&](int client) {
    if (::send(client, &frame, sizeof frame, MSG_DONTWAIT | MSG_NOSIGNAL) == sizeof frame)
      return false;
    // A viewer that is slow loses this frame; one that has gone is forgotten.
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
