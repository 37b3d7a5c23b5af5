// SPDX-License-Identifier: Apache-2.0
#include "tools/program/interrupt.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <string_view>

#include "tools/program/child_groups.h"

namespace tact::tools::program {
namespace {

std::atomic<bool> pressed{false};
constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGQUIT};
static_assert(std::atomic<bool>::is_always_lock_free, "may be set by a signal handler");

void remember(int signal) {
  const bool again = pressed.exchange(true);
  if (!again && signal == SIGINT) {
    constexpr std::string_view kMessage = "\nstopping after this step; Ctrl-C again: now\n";
    [[maybe_unused]] const auto n = write(STDERR_FILENO, kMessage.data(), kMessage.size());
  }
  if (!again || signal == SIGHUP) return;  // a closed terminal may send it twice
  end_child_groups();
  _exit(128 + signal);  // as a shell reports it
}

}  // namespace

InterruptFlag::InterruptFlag() {
  pressed.store(false);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction watched{};
    watched.sa_handler = remember;
    watched.sa_flags = SA_RESTART;
    sigaction(kSignals[i], &watched, &before_[i]);
    // nohup
    if (kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN)
      sigaction(SIGHUP, &before_[i], nullptr);
  }
}

InterruptFlag::~InterruptFlag() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  pressed.store(false);
}

bool is_interrupted() { return pressed.load(); }

}  // namespace tact::tools::program
