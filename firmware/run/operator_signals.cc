// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/operator_signals.h"

#include <pthread.h>

#include <utility>

namespace tact::firmware::run {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

sigset_t requests_of_a_person() {
  sigset_t set{};
  sigemptyset(&set);
  for (const int signal : {SIGUSR1, SIGUSR2}) sigaddset(&set, signal);
  return set;
}

}  // namespace

void wait_several_ticks() {
  constexpr timespec kSeveralTicks{.tv_sec = 0, .tv_nsec = 20'000'000};
  nanosleep(&kSeveralTicks, nullptr);
}

void outlive_stray_signals() {
  const sigset_t requests = requests_of_a_person();
  pthread_sigmask(SIG_BLOCK, &requests, nullptr);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGALRM, SIGIO, SIGPROF, SIGVTALRM, SIGPWR, SIGSTKFLT})
    std::signal(signal, SIG_IGN);
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) std::signal(signal, SIG_IGN);
}

OperatorSignals::OperatorSignals(std::function<void()> let_loop_read)
    : signals_(requests_of_a_person()), let_loop_read_(std::move(let_loop_read)) {
  std::signal(SIGINT, SIG_DFL);  // a shell starts background programs with SIGINT ignored
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) sigaddset(&signals_, signal);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

Act OperatorSignals::wait(std::int64_t longest_ns) const {
  const timespec longest{.tv_sec = longest_ns / kSecond_ns, .tv_nsec = longest_ns % kSecond_ns};
  const int signal = sigtimedwait(&signals_, nullptr, &longest);
  if (signal == SIGUSR1) return Act::kReset;
  if (signal == SIGUSR2) return Act::kArm;
  return signal > 0 ? Act::kLeave : Act::kNone;
}

int OperatorSignals::forget() const {
  constexpr timespec kNow{};
  const sigset_t requests = requests_of_a_person();
  int forgotten = 0;
  while (sigtimedwait(&requests, nullptr, &kNow) > 0) ++forgotten;
  return forgotten;
}

void OperatorSignals::raise_edge(std::atomic<bool>& request) const {
  request.store(true);
  let_loop_read_();
  request.store(false);
  let_loop_read_();
}

}  // namespace tact::firmware::run
