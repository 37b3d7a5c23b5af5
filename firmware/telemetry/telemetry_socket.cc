// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/telemetry_socket.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace tact::firmware::telemetry {
namespace {

using model::Error;
using model::Result;

constexpr std::size_t kMaxClients = 16;

Error failed(const std::string& what, const std::string& cure) {
  return Error{fmt::format("{}: {}; {}", what, std::strerror(errno), cure)};
}

// A file of a dead tactd is replaced; a living one is not disturbed.
bool somebody_listens(const sockaddr_un& address) {
  const int probe = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const bool alive =
      probe >= 0 && (connect(probe, model::io::plain(address), sizeof address) == 0 ||
                     errno == EAGAIN);  // alive, with a full queue
  if (probe >= 0) close(probe);
  return alive;
}

bool is_socket(const std::string& path) {
  struct stat info{};
  return lstat(path.c_str(), &info) == 0 && S_ISSOCK(info.st_mode);
}

}  // namespace

Result<TelemetrySocket> TelemetrySocket::open(const std::string& path, const Hello& hello,
                                              int mesh_fd, std::optional<gid_t> viewers) {
  const auto address = model::io::socket_address(path);
  if (!address) return address.error();
  if (auto shared = model::io::check_socket_folder(path)) return std::move(*shared);
  if (somebody_listens(*address))
    return Error{path + ": another tactd is running there; stop it, or choose another --socket"};
  if (is_socket(path)) unlink(path.c_str());
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const mode_t before = umask(0177);  // 0600 from the first moment
  const bool bound = fd >= 0 && bind(fd, model::io::plain(*address), sizeof *address) == 0;
  umask(before);
  if (!bound || listen(fd, 8) != 0) {
    const Error error = failed(path, "choose a folder that you may write to with --socket");
    if (fd >= 0) close(fd);
    return error;
  }
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
    if (model::io::has_trusted_peer(client, trust_) && greet(client))
      clients_.push_back(client);
    else
      close(client);
  }
}

bool TelemetrySocket::greet(int client_fd) const {
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
