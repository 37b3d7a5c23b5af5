// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/operator_signals.h"

#include <pthread.h>

#include <utility>

namespace tact::firmware::run {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

}  // namespace

void wait_several_ticks() {
  constexpr timespec kSeveralTicks{.tv_sec = 0, .tv_nsec = 20'000'000};
  nanosleep(&kSeveralTicks, nullptr);
}

OperatorSignals::OperatorSignals(std::function<void()> let_loop_read)
    : let_loop_read_(std::move(let_loop_read)) {
  std::signal(SIGINT, SIG_DFL);  // a shell starts background programs with SIGINT ignored
  sigemptyset(&signals_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2})
    sigaddset(&signals_, signal);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

void OperatorSignals::reset(loop::Requests& requests) const {
  requests.arm.store(false);
  let_loop_read_();
  requests.reset.store(true);
  let_loop_read_();
  requests.reset.store(false);
}

void OperatorSignals::obey(loop::Requests& requests, std::int64_t longest_ns) const {
  const timespec longest{.tv_sec = longest_ns / kSecond_ns, .tv_nsec = longest_ns % kSecond_ns};
  const int signal = sigtimedwait(&signals_, nullptr, &longest);
  if (signal == SIGUSR1)
    reset(requests);
  else if (signal == SIGUSR2)
    requests.arm.store(true);
  else if (signal > 0)
    requests.stop.store(true);
}

}  // namespace tact::firmware::run
