// SPDX-License-Identifier: Apache-2.0
#include "hal/device_lock.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <mutex>
#include <set>

#include "model/io/input_file.h"

namespace tact::hal {
namespace {

using model::Error;

constexpr std::string_view kPrefix{"\0tact/device/", 13};  // the zero makes a name abstract
constexpr int kManyRefused = 4096;  // each of them waits in the queue of the one who has it
// 50 ms in all: the other program may stand between bind and listen.
constexpr int kLooks = 50, kLook_us = 1000;

class Address {
 public:
  explicit Address(const std::string& name) {
    const std::string whole = std::string(kPrefix) + name;
    fits_ = whole.size() <= sizeof address_.sun_path;
    address_.sun_family = AF_UNIX;
    std::copy_n(whole.data(), std::min(whole.size(), sizeof address_.sun_path), address_.sun_path);
    // Exactly the name: in an abstract name trailing zeros would count.
    bytes_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + whole.size());
  }
  bool fits() const { return fits_; }
  const sockaddr* plain() const { return reinterpret_cast<const sockaddr*>(&address_); }
  socklen_t bytes() const { return bytes_; }

 private:
  sockaddr_un address_{};
  socklen_t bytes_ = 0;
  bool fits_ = false;
};

int make_socket() { return socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0); }

/// 0: it does not listen yet, or its queue is full, or it is of another PID namespace.
ucred ask_who_listens(const Address& address) {
  ucred peer{};
  socklen_t bytes = sizeof peer;
  for (int look = 0; look < kLooks && peer.pid == 0; ++look) {
    const int probe = make_socket();
    const bool heard = connect(probe, address.plain(), address.bytes()) == 0;
    if (heard) getsockopt(probe, SOL_SOCKET, SO_PEERCRED, &peer, &bytes);
    if (probe >= 0) close(probe);
    if (!heard) usleep(kLook_us);
  }
  return peer;
}

std::string text_of(const ucred& peer) {
  if (peer.pid == 0) return "another program";
  const auto comm = model::io::read_file(fmt::format("/proc/{}/comm", peer.pid));
  const std::string name = comm ? comm->substr(0, comm->find('\n')) : "";
  // Any user may hold the name; root can end what only holds it.
  return fmt::format("process {}{}{}", peer.pid, name.empty() ? "" : " (" + name + ")",
                     peer.uid == geteuid() ? "" : fmt::format(" of user {}", peer.uid));
}

Error cannot_lock(const std::string& name, int error) {
  return Error{
      fmt::format("{} cannot be locked for this program alone ({}): it needs a socket of AF_UNIX, "
                  "which a sandbox or a full table of open files may forbid (ulimit -n)",
                  name, std::strerror(error))};
}

Error taken(const std::string& name, const Address& address) {
  return Error{
      fmt::format("{} is driven by {} already, and two would push against each other: end "
                  "that one first, as root if it is another user's",
                  name, text_of(ask_who_listens(address)))};
}

}  // namespace

std::optional<Error> lock_device(const std::string& name) {
  // By name, and for the whole process: one that opens a device again has it already.
  static std::mutex mutex;
  static std::set<std::string> ours;
  const std::lock_guard<std::mutex> guard(mutex);
  if (ours.contains(name)) return std::nullopt;
  const Address address(name);
  if (!address.fits())
    return Error{fmt::format("the device's name is too long to lock it: {}; rename it", name)};
  const int lock = make_socket();
  if (lock < 0) return cannot_lock(name, errno);
  if (bind(lock, address.plain(), address.bytes()) == 0 && listen(lock, kManyRefused) == 0) {
    ours.insert(name);  // the socket stays open until the process ends
    return std::nullopt;
  }
  const int error = errno;
  close(lock);
  if (error == EADDRINUSE) return taken(name, address);
  return cannot_lock(name, error);
}

}  // namespace tact::hal
