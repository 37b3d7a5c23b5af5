// SPDX-License-Identifier: Apache-2.0
// release_schedule.h - the loop's deadlines: a fixed release schedule of CLOCK_MONOTONIC. Watch,
// frames and status lines wake halfway between two deadlines; tact-fd avoids the deadlines, too.
//
// The kernel's timer tick comes at whole multiples of 1/HZ of that clock (/proc/timer_list of
// Debian's 6.1). With an arbitrary first deadline the kernel's tick, or a timer of another thread,
// could disturb the same part of every tick of a run. So the deadline is placed after the kernel's
// tick: by 0.3 of a period, at most by 0.3 ms. This needs a period that divides 1 ms or is a
// multiple of it. With any other period, such as that of 3 kHz, the phase of the kernel's tick
// drifts, and no choice of the first deadline avoids the disturbance.
#pragma once

#include <algorithm>
#include <cstdint>

#include "model/rt.h"
#include "model/time_ns.h"

namespace tact::firmware::loop {

/// The first multiple of period_ns, shifted by phase_ns, at or after from_ns >= 0.
constexpr std::int64_t next_in_phase_ns(std::int64_t from_ns, std::int64_t period_ns,
                                        std::int64_t phase_ns) RT_SAFE {
  const std::int64_t since_ns = (from_ns - phase_ns) % period_ns;
  return since_ns <= 0 ? from_ns - since_ns : from_ns - since_ns + period_ns;
}

/// Delay of a deadline after the kernel's tick, which comes at most once a millisecond.
constexpr std::int64_t after_kernel_tick_ns(std::int64_t period_ns) RT_SAFE {
  return std::min(period_ns, model::kMillisecond_ns) * 3 / 10;
}

/// The loop's first deadline at or after from_ns.
constexpr std::int64_t next_deadline_ns(std::int64_t from_ns, std::int64_t period_ns) RT_SAFE {
  return next_in_phase_ns(from_ns, period_ns, after_kernel_tick_ns(period_ns));
}

/// The first time at or after from_ns that is halfway between two deadlines.
constexpr std::int64_t next_half_way_ns(std::int64_t from_ns, std::int64_t period_ns) RT_SAFE {
  return next_in_phase_ns(from_ns, period_ns, after_kernel_tick_ns(period_ns) + period_ns / 2);
}

/// Number of deadlines, from due_ns on, that have passed at now_ns: the loop skips them.
constexpr std::int64_t periods_missed(std::int64_t due_ns, std::int64_t now_ns,
                                      std::int64_t period_ns) RT_SAFE {
  return now_ns < due_ns ? 0 : (now_ns - due_ns) / period_ns + 1;
}

}  // namespace tact::firmware::loop
