// SPDX-License-Identifier: Apache-2.0
#include "host/net/stop_signals.h"

#include <sys/signalfd.h>

#include <csignal>
#include <utility>

namespace tact::host::net {

boost::system::error_code StopSignals::wait(std::function<void()> stop) {
  sigset_t asked;
  sigemptyset(&asked);
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, SIG_DFL);  // a shell starts background programs with SIGINT ignored
    sigaddset(&asked, signal);
  }
  pthread_sigmask(SIG_BLOCK, &asked, nullptr);
  boost::system::error_code wrong;
  signals_.assign(signalfd(-1, &asked, SFD_NONBLOCK | SFD_CLOEXEC), wrong);
  // An error of the wait ends the program, too: it could not be stopped any more.
  if (!wrong)
    signals_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                        [stop = std::move(stop)](boost::system::error_code) { stop(); });
  return wrong;
}

}  // namespace tact::host::net
