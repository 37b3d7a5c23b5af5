// SPDX-License-Identifier: Apache-2.0
#include "host/net/stop_signals.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <utility>

namespace tact::host::net {
namespace {

int stop_fd = -1;

/// In any thread: libraries have theirs, which block nothing.
void on_signal(int) {
  constexpr int kTries = 10;
  constexpr std::uint64_t kOne = 1;
  const int before = errno;
  for (int i = 0; i < kTries && write(stop_fd, &kOne, sizeof kOne) < 0; ++i) continue;
  errno = before;
}

}  // namespace

boost::system::error_code StopSignals::wait(std::function<void()> stop) {
  stop_fd = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  boost::system::error_code wrong;
  signals_.assign(stop_fd, wrong);
  if (wrong) return wrong;
  // An error of the wait ends the program, too: it could not be stopped any more.
  signals_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                      [stop = std::move(stop)](boost::system::error_code) { stop(); });
  struct sigaction action{};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
  return wrong;
}

}  // namespace tact::host::net
