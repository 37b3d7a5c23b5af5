#include "firmware/operator_signals.h"

#include <pthread.h>

namespace tact::firmware {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr timespec kSeveralTicks{.tv_sec = 0, .tv_nsec = 20'000'000};  // at 100 Hz two

// The loop reads levels once per tick, so each must stand for some.
void reset(Requests& requests) {
  requests.arm.store(false);
  nanosleep(&kSeveralTicks, nullptr);
  requests.reset.store(true);
  nanosleep(&kSeveralTicks, nullptr);
  requests.reset.store(false);
}

}  // namespace

OperatorSignals::OperatorSignals() {
  std::signal(SIGINT, SIG_DFL);  // a shell starts background programs with SIGINT ignored
  sigemptyset(&signals_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2})
    sigaddset(&signals_, signal);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

void OperatorSignals::obey(Requests& requests, std::int64_t longest_ns) const {
  const timespec longest{.tv_sec = longest_ns / kSecond_ns, .tv_nsec = longest_ns % kSecond_ns};
  const int signal = sigtimedwait(&signals_, nullptr, &longest);
  if (signal == SIGUSR1)
    reset(requests);
  else if (signal == SIGUSR2)
    requests.arm.store(true);
  else if (signal > 0)
    requests.stop.store(true);
}

}  // namespace tact::firmware
