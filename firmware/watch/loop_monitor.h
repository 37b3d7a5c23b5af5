// SPDX-License-Identifier: Apache-2.0
// loop_monitor.h - the thread above the loop: when the loop cannot stop the force, it does.
//
// It wakes every 5 periods, halfway between two deadlines of the loop (release_schedule.h), above
// the loop's priority and on another core where there is one. When the loop stalls, hangs in a call
// or runs away (runaway.h), a call of it was refused (call_filter.h), or its guardian is lost:
//
//     the fault is set for the loop   zero force in the first tick to come, latched until the end
//     enable and heartbeat drop       by this thread itself, at this check and every one after
//
// It cannot write to the device: a call of the loop may be under way there. Without an enable line
// the drives' own watchdogs have to act. No lock, no heap: only Progress, Requests and the lines.
#pragma once

#include <thread>

#include "firmware/loop/clock.h"
#include "firmware/loop/rt_loop.h"
#include "firmware/pc/rt_setup.h"
#include "firmware/watch/stall_detector.h"

namespace tact::firmware::watch {

class LoopMonitor {
 public:
  /// `guardian_lost`: of the process that zeroes the device after this one (firmware/guardian);
  /// null: there is none.
  LoopMonitor(const StallDetector& stall, const loop::Progress& progress, loop::Requests& requests,
              hal::SafetyLines& lines, const std::atomic<bool>* guardian_lost = nullptr)
      : stall_(stall),
        progress_(progress),
        requests_(requests),
        lines_(lines),
        guardian_lost_(guardian_lost) {}
  ~LoopMonitor() { stop(); }
  LoopMonitor(const LoopMonitor&) = delete;
  LoopMonitor& operator=(const LoopMonitor&) = delete;

  void start(const pc::RtSettings& loop);
  void stop();
  /// One check, at any time.
  void check() RT_SAFE;

 private:
  void run() RT_SAFE;
  std::int64_t next_ns(std::int64_t now_ns) const RT_SAFE;

  StallDetector stall_;
  const loop::Progress& progress_;
  loop::Requests& requests_;
  hal::SafetyLines& lines_;
  const std::atomic<bool>* guardian_lost_;
  loop::MonotonicClock clock_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace tact::firmware::watch
