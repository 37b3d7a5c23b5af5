// SPDX-License-Identifier: Apache-2.0
// monotonic.h - the time that stamps what devices say: CLOCK_MONOTONIC, ns since boot.
//
// The loop's own clock is firmware/loop/clock.h; this is the same clock for code below it. Source:
// man 2 clock_gettime.
#pragma once

#include <cstdint>
#include <ctime>

#include "model/rt.h"
#include "model/time_ns.h"

namespace tact::hal {

// The call the kernel must answer, from its vDSO: the compiler cannot see that it is bounded.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
inline std::int64_t monotonic_ns() RT_SAFE {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * model::kSecond_ns + t.tv_nsec;
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

}  // namespace tact::hal
