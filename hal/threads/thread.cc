// SPDX-License-Identifier: Apache-2.0
#include "hal/threads/thread.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>

namespace tact::hal::threads {
namespace {

/// By the kernel's call: glibc leaves two signals of its own (nptl(7)) unblocked, whose handler
/// makes calls that the loop's filter refuses.
void block_signals() {
  std::uint64_t blocked = ~std::uint64_t{0};
  for (const int signal : {SIGSYS, SIGXCPU, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP})
    blocked &= ~(std::uint64_t{1} << (signal - 1));
  syscall(SYS_rt_sigprocmask, SIG_SETMASK, &blocked, nullptr, sizeof blocked);
}

void run(const char* name, const std::function<void()>& body) {
  block_signals();
  pthread_setname_np(pthread_self(), name);
  try {
    body();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "the thread %s has ended (%s), so the program ends\n", name, error.what());
    kill(getpid(), SIGTERM);
  } catch (...) {
    std::fprintf(stderr, "the thread %s has ended, so the program ends\n", name);
    kill(getpid(), SIGTERM);
  }
}

}  // namespace

model::Result<Thread> start_thread(const char* name, std::function<void()> body) {
  try {
    return Thread(std::thread(run, name, std::move(body)));
  } catch (const std::exception& refused) {
    return model::Error{fmt::format(
        "the thread {} cannot be started ({}): end other programs, or raise ulimit -u and -v", name,
        refused.what())};
  }
}

}  // namespace tact::hal::threads
