// SPDX-License-Identifier: Apache-2.0
// loop_monitor.h - the watch: a thread that removes the force when the loop cannot.
//
// It wakes every 5 periods, halfway between two deadlines of the loop (release_schedule.h), above
// the loop's priority and, if possible, on another core. It acts when the loop stalls, hangs in a
// call or runs away (runaway.h), when call_filter.h refused a call, when the guardian is lost or
// held, or after the PC was suspended:
//
//     it sets the fault               the loop's next tick gives zero force and latches the fault
//     it drops enable and heartbeat   itself, at this check and at every later one
//
// It does not write to the device, because the loop may be inside a device call. Without an enable
// line the drives' own watchdogs must act. No lock, no heap: only Progress, Requests and the lines.
#pragma once

#include <optional>

#include "firmware/loop/clock.h"
#include "firmware/loop/rt_loop.h"
#include "firmware/pc/rt_setup.h"
#include "firmware/watch/stall_detector.h"
#include "firmware/watch/suspend_detector.h"
#include "hal/threads/thread.h"

namespace tact::firmware::watch {

/// The process that zeroes the device when tactd has died or is held (firmware/guardian).
struct GuardianLink {
  const std::atomic<bool>* is_lost = nullptr;  // it has ended; null: there is no guardian
  std::atomic<std::uint64_t>* own_count =
      nullptr;  // it acts when this stops counting; 0: not watched
  const std::atomic<std::uint64_t>* its_count = nullptr;
};

class LoopMonitor {
 public:
  LoopMonitor(const StallDetector& stall, const loop::Progress& progress, loop::Requests& requests,
              hal::SafetyLines& lines, const GuardianLink& guardian = {})
      : stall_(stall),
        progress_(progress),
        requests_(requests),
        lines_(lines),
        guardian_(guardian) {}
  ~LoopMonitor() { stop(); }
  LoopMonitor(const LoopMonitor&) = delete;
  LoopMonitor& operator=(const LoopMonitor&) = delete;

  [[nodiscard]] std::optional<model::Error> start(const pc::RtSettings& loop);
  void stop();
  /// One check; may be called at any time.
  void check() RT_SAFE;

 private:
  void run() RT_SAFE;
  bool is_guardian_gone() RT_SAFE;
  void leave_guardian() RT_SAFE;
  std::int64_t next_ns(std::int64_t now_ns) const RT_SAFE;

  StallDetector stall_;
  const loop::Progress& progress_;
  loop::Requests& requests_;
  hal::SafetyLines& lines_;
  GuardianLink guardian_;
  std::uint64_t guardian_before_ = 0;
  std::int64_t guardian_still_ns_ = 0;  // since it counted
  SuspendDetector suspend_;
  loop::MonotonicClock clock_;
  std::atomic<bool> ending_{false};
  hal::threads::Thread thread_;
};

}  // namespace tact::firmware::watch
