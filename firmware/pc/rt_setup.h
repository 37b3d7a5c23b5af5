// SPDX-License-Identifier: Apache-2.0
// rt_setup.h - requests hard real time from the PC, and reports what the PC refuses.
//
// Process: kernel with PREEMPT_RT, memory locked and kept, power latency held at 0. Thread:
// SCHED_FIFO, one core of its own, touched stack, denormals flushed. Why: RT-1 .. RT-8.
#pragma once

#include <string>
#include <vector>

#include "firmware/pc/rt_needs.h"

namespace tact::firmware::pc {

/// One requirement that this PC does not meet: what is missing, and the remedy.
struct Shortfall {
  std::string message;
};

struct RtSettings {
  int priority = kLoopPriority;  // SCHED_FIFO of the loop; its watch has 5 more
  int core = -1;                 // -1: an isolated core if there is one, else the last allowed one
};

/// Locks memory, and holds the power latency during its lifetime.
class ProcessSetup {
 public:
  explicit ProcessSetup(std::vector<Shortfall>& shortfalls);
  ~ProcessSetup();
  ProcessSetup(const ProcessSetup&) = delete;
  ProcessSetup& operator=(const ProcessSetup&) = delete;

 private:
  int latency_fd_ = -1;
};

/// Small default stacks, because a locked process commits every byte of them. Call before any
/// thread starts.
void use_small_thread_stacks();
/// Call first in the loop's thread.
void enter_rt_thread(const RtSettings& settings, std::vector<Shortfall>& shortfalls);
/// The same for the watch of that loop: 5 priorities above it, on any core but the loop's.
void enter_watch_thread(const RtSettings& loop, std::vector<Shortfall>& shortfalls);
/// What either of the two would be refused, tried in a thread of its own.
std::vector<Shortfall> probe_rt_threads(const RtSettings& loop);
/// Call last in that thread: freeing its memory at FIFO priority would delay all others.
void leave_rt_thread();
/// Treats denormals as zero: they cost a hundred times a normal number. Same bits in a replay.
void flush_denormals();

/// The core that the loop will use.
int choose_core(const RtSettings& settings);

}  // namespace tact::firmware::pc
