// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/hand_socket.h"

#include <fmt/core.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

namespace tact::hal::sim {
namespace {

using model::Error;
using model::Result;

constexpr double kFarthest_m = 1.0;  // no hand is farther from the middle of this device

Error system_error(const std::string& path, const char* what) {
  return {fmt::format("{}: {}: {}; choose a writable place for the hand socket", path, what,
                      std::strerror(errno))};
}

/// Removes the socket file of a process that is gone; refuses anything else that is in the way.
Result<bool> clear_the_way(const std::string& path, const sockaddr_un& address) {
  struct stat status{};
  if (lstat(path.c_str(), &status) != 0) {
    if (errno == ENOENT) return true;
    return system_error(path, "cannot look at it");
  }
  if (!S_ISSOCK(status.st_mode))
    return Error{fmt::format("{}: is a file, not a socket; choose another name", path)};
  const int probe = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool alive = probe >= 0 && connect(probe, model::io::plain(address), sizeof address) == 0;
  if (probe >= 0) close(probe);
  if (alive) {
    return Error{
        fmt::format("{}: another process listens here; stop it, or choose another --socket", path)};
  }
  if (unlink(path.c_str()) != 0) return system_error(path, "cannot replace the old socket");
  return true;
}

}  // namespace

bool is_sound(const HandTarget& target) RT_SAFE {
  if (target.magic != kHandTargetMagic || target.version != kHandTargetVersion) return false;
  for (const double x : target.position_m)
    if (!(std::abs(x) <= kFarthest_m)) return false;
  return std::isfinite(target.grip_ratio);
}

Result<std::unique_ptr<HandSocket>> HandSocket::start(const std::string& path,
                                                      LatestSlot<HandTarget>& newest) {
  const auto address = model::io::socket_address(path);
  if (!address) return address.error();
  if (auto shared = model::io::check_socket_folder(path)) return std::move(*shared);
  if (const auto clear = clear_the_way(path, *address); !clear) return clear.error();
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return system_error(path, "cannot make a socket");
  // The mode of the file is that of the descriptor when it is bound: at no time is it open to
  // others.
  if (fchmod(descriptor, 0600) != 0 ||
      bind(descriptor, model::io::plain(*address), sizeof *address) != 0) {
    const Error error = system_error(path, "cannot listen");
    close(descriptor);
    return error;
  }
  return std::unique_ptr<HandSocket>(new HandSocket(descriptor, path, newest));
}

HandSocket::HandSocket(int descriptor, const std::string& path, LatestSlot<HandTarget>& newest)
    : descriptor_(descriptor), path_(path), file_(path), newest_(newest), thread_([this] {
        listen();
      }) {}

HandSocket::~HandSocket() { stop(); }

void HandSocket::stop() {
  if (!thread_.joinable()) return;
  stopping_ = true;
  shutdown(descriptor_, SHUT_RD);  // ends the wait
  thread_.join();
  close(descriptor_);
  file_.remove();
}

void HandSocket::listen() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);  // signals are for the thread that waits for them
  while (!stopping_) {
    HandTarget target;
    // MSG_TRUNC gives the true size, so that a longer datagram is not mistaken for a target.
    const ssize_t size = recv(descriptor_, &target, sizeof target, MSG_TRUNC);
    if (size == static_cast<ssize_t>(sizeof target) && is_sound(target)) newest_.write(target);
  }
}

}  // namespace tact::hal::sim
