// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/operator_signals.h"

#include <poll.h>
#include <pthread.h>
#include <sys/signalfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "model/time_ns.h"

namespace tact::firmware::console {
namespace {

constexpr int kLastSignal = 64;
constexpr std::array kLeave{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGABRT};
/// Signals that cannot be ignored, and signals that end nothing by default.
constexpr std::array kLeftAlone{SIGKILL, SIGSTOP, SIGCHLD, SIGCONT, SIGURG, SIGWINCH};

/// glibc reserves two signals (nptl(7)) and refuses to ignore them, so this calls the kernel
/// directly. glibc installs its own handlers when it needs them.
void ignore_one_of_glibc(int signal) {
  const std::array<std::uintptr_t, 4> kernel_sigaction{reinterpret_cast<std::uintptr_t>(SIG_IGN)};
  // The size of the kernel's set of 64 signals.
  constexpr std::size_t kMaskBytes = kLastSignal / 8;
  syscall(SYS_rt_sigaction, signal, kernel_sigaction.data(), nullptr, kMaskBytes);
}

/// Keeps an existing handler, such as that of a sanitizer.
void ignore(int signal) {
  struct sigaction now{};
  if (sigaction(signal, nullptr, &now) != 0) return ignore_one_of_glibc(signal);
  if (now.sa_handler == SIG_DFL) std::signal(signal, SIG_IGN);
}

}  // namespace

void ignore_other_signals() {
  const auto is_one_of = [](int signal, const auto& some) {
    return std::ranges::find(some, signal) != some.end();
  };
  for (int signal = 1; signal <= kLastSignal; ++signal)
    if (!is_one_of(signal, kLeave) && !is_one_of(signal, kLeftAlone)) ignore(signal);
}

OperatorSignals::OperatorSignals() {
  std::signal(SIGINT, SIG_DFL);  // a shell starts background programs with SIGINT ignored
  // Blocked in this thread and its later threads: in any other thread it would end the process.
  sigemptyset(&signals_);
  for (const int signal : kLeave) sigaddset(&signals_, signal);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  signal_fd_ = signalfd(-1, &signals_, SFD_NONBLOCK | SFD_CLOEXEC);
}

OperatorSignals::~OperatorSignals() {
  if (signal_fd_ >= 0) close(signal_fd_);
}

bool OperatorSignals::wait_for_end(std::int64_t longest_ns, int other_fd) const {
  constexpr timespec kNow{};
  const timespec longest{.tv_sec = longest_ns / model::kSecond_ns,
                         .tv_nsec = longest_ns % model::kSecond_ns};
  std::array<pollfd, 2> either{{{.fd = signal_fd_, .events = POLLIN, .revents = 0},
                                {.fd = other_fd, .events = POLLIN, .revents = 0}}};
  ppoll(either.data(), either.size(), &longest, nullptr);
  // signal_fd_ only wakes the poll. sigtimedwait takes the signal, also without a descriptor.
  return sigtimedwait(&signals_, nullptr, &kNow) > 0;
}

}  // namespace tact::firmware::console
