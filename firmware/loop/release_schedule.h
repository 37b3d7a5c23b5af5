// SPDX-License-Identifier: Apache-2.0
// release_schedule.h - when things happen: the loop's deadlines are a fixed release schedule of
// CLOCK_MONOTONIC; the watch, frames and status lines wake halfway between two of them (tact-fd
// keeps away, too).
//
// The kernel's own tick comes at whole multiples of 1/HZ of that clock (/proc/timer_list of
// Debian's 6.1). Were the first deadline at any time, the kernel's tick, or a timer of another
// thread, could disturb the same part of every tick of a run. Here the kernel's tick comes before
// the deadline: by 0.3 of a period, or by 0.3 ms where the period is longer than 1 ms.
// This needs a period that divides 1 ms or is a multiple of it. With others, as that of 3 kHz, the
// two clocks drift past each other, and no choice of the first deadline avoids it.
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

/// From the kernel's tick, which comes at most once a millisecond, to a deadline.
constexpr std::int64_t after_kernel_tick_ns(std::int64_t period_ns) RT_SAFE {
  return std::min(period_ns, model::kMillisecond_ns) * 3 / 10;
}

/// The loop's first deadline at or after from_ns.
constexpr std::int64_t next_deadline_ns(std::int64_t from_ns, std::int64_t period_ns) RT_SAFE {
  return next_in_phase_ns(from_ns, period_ns, after_kernel_tick_ns(period_ns));
}

/// The first instant at or after from_ns that lies halfway between two deadlines.
constexpr std::int64_t next_half_way_ns(std::int64_t from_ns, std::int64_t period_ns) RT_SAFE {
  return next_in_phase_ns(from_ns, period_ns, after_kernel_tick_ns(period_ns) + period_ns / 2);
}

/// Deadlines that have passed at now_ns, from due_ns on: a loop skips them all.
constexpr std::int64_t periods_missed(std::int64_t due_ns, std::int64_t now_ns,
                                      std::int64_t period_ns) RT_SAFE {
  return now_ns < due_ns ? 0 : (now_ns - due_ns) / period_ns + 1;
}

}  // namespace tact::firmware::loop
