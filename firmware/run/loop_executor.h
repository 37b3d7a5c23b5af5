// SPDX-License-Identifier: Apache-2.0
// loop_executor.h - runs the loop, with the threads around it, from its first tick to the device's
// rest.
//
//     tact-loop    the loop behind its call filter (watch/call_filter.h)
//     tact-watch   above it (watch/loop_monitor.h)
//     keeper       starts the loop; stops the device as soon as it has ended
//     main         signals, status line, hangs (serve_operator in session.cc)
//
// Loops may follow each other on one device, each in a thread of its own behind the same filter.
// A loop that does not end when it is asked to is left behind: the process ends without it.
#pragma once

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "firmware/guardian/guardian.h"
#include "firmware/run/thread_costs.h"
#include "firmware/watch/call_filter.h"
#include "firmware/watch/loop_monitor.h"
#include "firmware/watch/runaway.h"

namespace tact::firmware::run {

/// One loop from its first tick to its letting go.
struct LoopRun {
  const loop::Progress& progress;
  std::function<void()> run;
};

struct GuardedLoop {
  std::vector<LoopRun> turns;  // one after the other, until a stop request
  hal::Device& device;
  hal::SafetyLines& lines;
  loop::Requests& requests;
  watch::CallFilter* filter = nullptr;  // none: any call is allowed
  const guardian::Guardian* guardian = nullptr;
  pc::RtSettings rt;
  std::int64_t period_ns = 0;
  bool hard_real_time = false;
};

class LoopExecutor {
 public:
  explicit LoopExecutor(const GuardedLoop& guarded);
  ~LoopExecutor() { join(); }
  LoopExecutor(const LoopExecutor&) = delete;
  LoopExecutor& operator=(const LoopExecutor&) = delete;

  bool ended() const { return ended_.load(); }
  /// Asked to stop, and 3 s later loop or device are still not at their end. Call a few times a
  /// second.
  bool hangs();
  /// After ended().
  void join();
  /// After hangs(): lines low, zero force if the device still answers, the shutdown frames, and out
  /// within 6 s. The kernel closes what is open; drives with a watchdog let go when they hear
  /// nothing.
  [[noreturn]] void leave_behind(int status, const std::function<void()>& shutdown_frames);
  /// Of all turns together, after join().
  const ThreadCosts& costs() const { return costs_; }

 private:
  void keep();
  void take(const LoopRun& turn);

  GuardedLoop guarded_;
  watch::RunawayGuard runaway_;
  std::atomic<bool> ended_{false};
  std::int64_t asked_ns_ = 0;  // when the stop request was first seen; 0: not yet
  ThreadCosts costs_;
  std::thread executor_;
};

}  // namespace tact::firmware::run
