// SPDX-License-Identifier: Apache-2.0
// thread_costs.h - the loop's thread: sets real time before the first tick, resets it after the
// last, and reads the counters of kernel and allocator in between.
#pragma once

#include <cstdint>
#include <functional>

#include "firmware/pc/rt_setup.h"
#include "firmware/watch/call_filter.h"

namespace tact::firmware::run {

/// Counters of the loop's thread between its first and its last tick.
struct ThreadCosts {
  std::uint64_t heap_calls = 0;
  bool heap_calls_known = false;
  bool call_filter = false;  // the filter was active
  long minor_faults = 0, major_faults = 0;
  long voluntary_switches = 0, involuntary_switches = 0;
};

/// Adds one run to a sum.
void add_to(ThreadCosts& sum, const ThreadCosts& more);

/// Makes the calling thread the loop's thread, runs `loop`, and resets the thread. A filter, if
/// any, stays with the thread to its end.
ThreadCosts run_as_loop_thread(const pc::RtSettings& settings, const std::function<void()>& loop,
                               watch::CallFilter* filter = nullptr);

}  // namespace tact::firmware::run
