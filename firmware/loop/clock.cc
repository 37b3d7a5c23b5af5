// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/clock.h"

#include <cerrno>
#include <ctime>

#include "model/time_ns.h"

namespace tact::firmware::loop {
// Two system calls; the compiler cannot verify that they are real-time safe.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
namespace {
std::int64_t clock_ns(clockid_t clock) RT_SAFE {
  timespec t{};
  clock_gettime(clock, &t);
  return t.tv_sec * model::kSecond_ns + t.tv_nsec;
}
}  // namespace

std::int64_t MonotonicClock::now_ns() RT_SAFE { return clock_ns(CLOCK_MONOTONIC); }

std::int64_t MonotonicClock::suspended_ns() RT_SAFE { return clock_ns(CLOCK_BOOTTIME) - now_ns(); }

void MonotonicClock::sleep_until_ns(std::int64_t deadline_ns) RT_SAFE {
  // TIMER_ABSTIME: after a signal the sleep is repeated with the same deadline. The error is the
  // return value; errno is not set.
  const timespec t{.tv_sec = deadline_ns / model::kSecond_ns,
                   .tv_nsec = deadline_ns % model::kSecond_ns};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

}  // namespace tact::firmware::loop
