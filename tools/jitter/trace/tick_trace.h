// SPDX-License-Identifier: Apache-2.0
// tick_trace.h - the kept ticks of a run as a timeline for ui.perfetto.dev.
#pragma once

#include <string>
#include <vector>

#include "tools/jitter/statistics/tick_times.h"

namespace tact::tools::jitter {

/// One slice a tick with its phases inside, the wake-up before it, a mark where points of the grid
/// had no tick, and the wake-up latency as a curve. `offset_ns`: CLOCK_BOOTTIME - CLOCK_MONOTONIC.
std::string make_tick_trace(const std::vector<TickTimes>& ticks, std::int64_t offset_ns);

/// Offset of this PC, now.
std::int64_t boottime_offset_ns();

}  // namespace tact::tools::jitter
