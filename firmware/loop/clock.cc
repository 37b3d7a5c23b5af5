// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/clock.h"

#include <cerrno>
#include <ctime>

namespace tact::firmware::loop {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

}  // namespace

// The two calls the kernel must answer: the compiler cannot see that they are bounded.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
std::int64_t MonotonicClock::now_ns() RT_SAFE {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kNsPerSecond + t.tv_nsec;
}

void MonotonicClock::sleep_until_ns(std::int64_t deadline_ns) RT_SAFE {
  // TIMER_ABSTIME: a sleep that a signal cuts short begins again with the same deadline and loses
  // no time. The error is the return value; errno is not set.
  const timespec t{.tv_sec = deadline_ns / kNsPerSecond, .tv_nsec = deadline_ns % kNsPerSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

}  // namespace tact::firmware::loop
