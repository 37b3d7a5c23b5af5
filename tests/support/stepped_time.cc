// SPDX-License-Identifier: Apache-2.0
#include "tests/support/stepped_time.h"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <ctime>

#include "model/time_ns.h"

namespace {

using tact::model::kSecond_ns;

constexpr long kCycle_ns = 200'000;
constexpr int kCycles = 2;         // the one that was under way, and a whole one
constexpr int kMaxWaits = 50'000;  // 10 s: a library that hangs is for the test to see

// The C library's own; null until the constants of this program are made. RTSan takes syscall() for
// a call that may wait for ever.
template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
const auto real_gettime = next<int(clockid_t, timespec*)>("clock_gettime");
const auto real_nanosleep =
    next<int(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep");

std::atomic<std::int64_t> stopped_at_ns{0};  // 0: time is real
std::atomic<int> sleeps{0};                  // of other threads
std::atomic<pthread_t> loop{};               // the thread that made the clock

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* t) noexcept {
  const std::int64_t at_ns = stopped_at_ns;
  if (real_gettime == nullptr) return static_cast<int>(syscall(SYS_clock_gettime, clock, t));
  if (clock != CLOCK_MONOTONIC || at_ns == 0) return real_gettime(clock, t);
  *t = {at_ns / kSecond_ns, at_ns % kSecond_ns};
  return 0;
}

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* due, timespec* left) {
  const timespec cycle{0, kCycle_ns};
  const bool is_deadline = clock == CLOCK_MONOTONIC && flags == TIMER_ABSTIME && stopped_at_ns != 0;
  if (is_deadline && pthread_self() != loop) ++sleeps;
  return is_deadline ? real_nanosleep(clock, 0, &cycle, nullptr)
                     : real_nanosleep(clock, flags, due, left);
}

namespace tact::tests {

SteppedTime::SteppedTime() { loop = pthread_self(); }

SteppedTime::~SteppedTime() { stopped_at_ns = 0; }

std::int64_t SteppedTime::now_ns() RT_SAFE {
  if (stopped_at_ns == 0) stopped_at_ns = real_.now_ns();
  return stopped_at_ns;
}

void SteppedTime::sleep_until_ns(std::int64_t deadline_ns) RT_SAFE {
  stopped_at_ns = std::max(now_ns(), deadline_ns);
  const int enough = sleeps + kCycles;
  for (int i = 0; sleeps < enough && i < kMaxWaits; ++i) real_.sleep_until_ns(deadline_ns);
}

}  // namespace tact::tests
