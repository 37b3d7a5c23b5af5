// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/thread_costs.h"

#include <sys/resource.h>

#include <vector>

#include "firmware/loop/alloc_counter.h"

namespace tact::firmware::run {

void add_to(ThreadCosts& sum, const ThreadCosts& more) {
  sum.heap_calls += more.heap_calls;
  // A property of the build, equal in all turns.
  sum.heap_calls_known = more.heap_calls_known;
  sum.call_filter = more.call_filter;
  sum.minor_faults += more.minor_faults;
  sum.major_faults += more.major_faults;
  sum.voluntary_switches += more.voluntary_switches;
  sum.involuntary_switches += more.involuntary_switches;
}

ThreadCosts run_as_loop_thread(const pc::RtSettings& settings, const std::function<void()>& loop,
                               watch::CallFilter* filter) {
  std::vector<pc::Shortfall> known;  // probe_rt_threads has reported them
  pc::enter_rt_thread(settings, known);
  ThreadCosts costs;
  // In this order: real time before the filter, which refuses FIFO; counters last, so that they
  // count only the loop.
  costs.call_filter = filter != nullptr && filter->enter_thread() == 0;  // make() has tried it
  rusage before{}, after{};
  {
    const loop::HeapCallCounter heap;
    getrusage(RUSAGE_THREAD, &before);
    loop();
    getrusage(RUSAGE_THREAD, &after);
    costs.heap_calls = heap.calls();
  }
  // The filter stays active; a refused call after this is not a fault of the loop.
  if (filter != nullptr) filter->leave_loop();
  pc::leave_rt_thread();
  costs.heap_calls_known = loop::can_count_heap_calls();
  costs.minor_faults = after.ru_minflt - before.ru_minflt;
  costs.major_faults = after.ru_majflt - before.ru_majflt;
  costs.voluntary_switches = after.ru_nvcsw - before.ru_nvcsw;
  costs.involuntary_switches = after.ru_nivcsw - before.ru_nivcsw;
  return costs;
}

}  // namespace tact::firmware::run
