// SPDX-License-Identifier: Apache-2.0
// rt_setup.h - ask the PC for hard real time, and say in plain words what it does not give.
//
// Process: kernel with PREEMPT_RT, memory locked and never given back, power latency held at 0.
// Thread: SCHED_FIFO, one core of its own, touched stack, denormals flushed. Why: RT-1 .. RT-8.
#pragma once

#include <string>
#include <vector>

#include "firmware/pc/rt_needs.h"

namespace tact::firmware::pc {

/// One thing this PC does not give: what is missing, and the remedy.
struct Shortfall {
  std::string message;
};

struct RtSettings {
  int priority = kLoopPriority;  // SCHED_FIFO of the loop; its watch has 5 more
  int core = -1;                 // -1: an isolated core if there is one, else the last allowed one
};

/// Locks memory and holds the power latency for as long as it lives.
class ProcessSetup {
 public:
  explicit ProcessSetup(std::vector<Shortfall>& shortfalls);
  ~ProcessSetup();
  ProcessSetup(const ProcessSetup&) = delete;
  ProcessSetup& operator=(const ProcessSetup&) = delete;

 private:
  int latency_fd_ = -1;
};

/// Small default stacks: a locked process pays for every byte of them. Call before any thread
/// starts.
void use_small_thread_stacks();
/// Call first in the loop's thread.
void enter_rt_thread(const RtSettings& settings, std::vector<Shortfall>& shortfalls);
/// The same for the watch above that loop: its priority + 5, on any core but the loop's.
void enter_watch_thread(const RtSettings& loop, std::vector<Shortfall>& shortfalls);
/// What both would be refused.
std::vector<Shortfall> probe_rt_threads(const RtSettings& loop);
/// Call last there: a thread that gives its memory back at FIFO priority holds up all others.
void leave_rt_thread();
/// Denormals are zero: they cost a hundred times a normal number. Same bits in loop and replay.
void flush_denormals();

/// The core that the loop will use.
int choose_core(const RtSettings& settings);

}  // namespace tact::firmware::pc
