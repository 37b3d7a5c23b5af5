// SPDX-License-Identifier: Apache-2.0
// runaway.h - stops a real-time thread that never sleeps and would hold its core forever.
//
// RLIMIT_RTTIME limits the CPU time that a SCHED_FIFO thread takes without a sleep. Beyond the soft
// limit the kernel sends SIGXCPU; here its handler trips a fault and ends the loop. The kernel
// counts in its timer ticks (1 to 10 ms). A nohz_full core has none: there the watch detects that
// the loop no longer ticks.
//
// Source: setrlimit(2), RLIMIT_RTTIME.
#pragma once

#include <sys/resource.h>

#include <vector>

#include "firmware/loop/rt_loop.h"
#include "firmware/pc/rt_setup.h"

namespace tact::firmware::watch {

/// Removes the inherited limits of CPU time, at which the kernel kills the process without a
/// message; a shortfall for each that has to stay. Call before any real-time thread starts.
std::vector<pc::Shortfall> lift_time_limits();

/// During its lifetime, 50 ms of CPU time without a sleep stop the loop. One instance at a time.
class RunawayGuard {
 public:
  static constexpr rlim_t kLongest_us = 50'000;

  explicit RunawayGuard(loop::Requests& requests, rlim_t longest_us = kLongest_us);
  ~RunawayGuard();
  RunawayGuard(const RunawayGuard&) = delete;
  RunawayGuard& operator=(const RunawayGuard&) = delete;

 private:
  rlimit before_{};
};

}  // namespace tact::firmware::watch
