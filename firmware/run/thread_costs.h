// SPDX-License-Identifier: Apache-2.0
// thread_costs.h - the thread in which a loop runs: real time before its first tick, ordinary again
// after its last, and what the kernel and the allocator counted between them.
#pragma once

#include <cstdint>
#include <functional>

#include "firmware/pc/rt_setup.h"
#include "firmware/watch/call_filter.h"

namespace tact::firmware::run {

/// Kernel's and allocator's view of the loop's thread between its first and its last tick.
struct ThreadCosts {
  std::uint64_t heap_calls = 0;
  bool heap_calls_known = false;
  bool call_filter = false;  // was on
  long minor_faults = 0, major_faults = 0;
  long voluntary_switches = 0, involuntary_switches = 0;
};

/// Of several runs together.
void add_to(ThreadCosts& sum, const ThreadCosts& more);

/// Runs `loop` as the loop's thread, which this one becomes and then leaves again; behind the
/// filter, if there is one, which stays with the thread to its end.
ThreadCosts run_as_loop_thread(const pc::RtSettings& settings, const std::function<void()>& loop,
                               watch::CallFilter* filter = nullptr);

}  // namespace tact::firmware::run
