// SPDX-License-Identifier: Apache-2.0
// runaway.h - a real-time thread that never sleeps: it would hold its core until the power is cut.
//
// RLIMIT_RTTIME counts the CPU time that a SCHED_FIFO thread takes without a sleep; beyond the soft
// limit the kernel sends SIGXCPU. Here that trips the fault and ends the loop. The kernel counts in
// its own ticks (1 to 10 ms), and not on a core that runs without them (nohz_full): there the watch
// sees that the loop no longer ticks.
//
// Source: setrlimit(2), RLIMIT_RTTIME.
#pragma once

#include <sys/resource.h>

#include <optional>

#include "firmware/loop/rt_loop.h"
#include "firmware/pc/rt_setup.h"

namespace tact::firmware::watch {

/// A limit that a session hands down ends a real-time process without a word, so it is lifted, or
/// told when that is not allowed. Before any real-time thread starts.
std::optional<pc::Shortfall> lift_rttime_limit();

/// While it lives, 50 ms without a sleep end in a stop. One at a time.
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
