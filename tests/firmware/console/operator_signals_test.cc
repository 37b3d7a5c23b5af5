// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/operator_signals.h"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>

#include "firmware/loop/alloc_counter.h"

namespace tact::firmware::console::operator_signals_test {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(OperatorSignals, EveryWayToEndAsksToLeave) {
  const OperatorSignals signals;
  sigset_t blocked{};
  pthread_sigmask(SIG_BLOCK, nullptr, &blocked);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGABRT}) {
    ASSERT_TRUE(sigismember(&blocked, signal)) << signal << " would end or halt this test";
    raise(signal);
    EXPECT_TRUE(signals.wait_for_end(kSecond_ns)) << signal;
  }
  EXPECT_FALSE(signals.wait_for_end(0));
}

bool asks_to_leave(int signal) {
  return signal == SIGINT || signal == SIGTERM || signal == SIGHUP || signal == SIGQUIT ||
         signal == SIGTSTP || signal == SIGABRT;
}

/// A sanitizer's own: it reports by them, and tactd leaves them alone.
bool is_caught(int signal) {
  struct sigaction now{};
  return sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_DFL &&
         now.sa_handler != SIG_IGN;
}

// In a process of its own, as the dispositions stay.
TEST(OperatorSignals, NothingThatComesBeforeTheLoopOrByMistakeEndsTheProcess) {
  const auto outlive = [] {
    ignore_other_signals();
    for (int signal = 1; signal <= 64; ++signal)
      if (!asks_to_leave(signal) && signal != SIGKILL && signal != SIGSTOP && !is_caught(signal))
        syscall(SYS_kill, getpid(), signal);
    const OperatorSignals signals;
    _exit(signals.wait_for_end(0) ? 8 : 7);
  };
  EXPECT_EXIT(outlive(), testing::ExitedWithCode(7), "");
}

TEST(OperatorSignals, ACrashEndsTheProcessAllTheSame) {
  const auto abort_it = [] {
    ignore_other_signals();
    const OperatorSignals signals;
    std::abort();
  };
  EXPECT_EXIT(abort_it(), testing::KilledBySignal(SIGABRT), "");
  if (loop::is_sanitized()) return;  // which has handlers of its own for the rest
  const auto read_nowhere = [] {
    ignore_other_signals();
    volatile const int* nowhere = nullptr;
    static_cast<void>(*nowhere);
  };
  EXPECT_EXIT(read_nowhere(), testing::KilledBySignal(SIGSEGV), "");
}

}  // namespace tact::firmware::console::operator_signals_test
