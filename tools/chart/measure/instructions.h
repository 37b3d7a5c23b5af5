// SPDX-License-Identifier: Apache-2.0
// instructions.h - what a call costs in instructions: the same number on an idle and a busy
// machine.
//
// Counted by the processor where Linux lets us (perf_event_open; virtual machines often hide the
// counter). Else a copy of this process is stepped through the call one instruction at a time:
// exact, but some 40 us each, so a call of more than kMaxSteps is not counted. Instructions of the
// kernel are not counted.
#pragma once

#include <cstddef>
#include <functional>

namespace tact::tools::chart {

inline constexpr std::size_t kMaxSteps = 300'000;  // of all calls together

/// Mean over up to `calls` calls; NaN where neither way works or one call is too long. Stepped, the
/// calls happen in the copy alone.
double instructions_per_call(const std::function<void()>& call, std::size_t calls);

/// The second way by itself, for tests.
double instructions_by_steps(const std::function<void()>& call, std::size_t calls,
                             std::size_t most_steps = kMaxSteps);

}  // namespace tact::tools::chart
