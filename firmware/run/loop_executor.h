// SPDX-License-Identifier: Apache-2.0
// loop_executor.h - runs the loop and the threads around it, until the device is stopped.
//
//     tact-loop    the loop behind its call filter (watch/call_filter.h)
//     tact-watch   monitors it (watch/loop_monitor.h)
//     executor     starts the loop; stops the device as soon as the loop has ended
//     tact-stop    stops the device of a loop that hangs
//     main         signals, status line, hangs (operator_service.h)
//
// Several loops may run one after another on one device, each in its own thread behind the same
// filter. A loop that does not end after a stop request is abandoned: the process exits without
// joining it.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <semaphore>
#include <vector>

#include "firmware/guardian/guardian.h"
#include "firmware/run/thread_costs.h"
#include "firmware/watch/call_filter.h"
#include "firmware/watch/loop_monitor.h"
#include "firmware/watch/runaway.h"
#include "hal/threads/thread.h"

namespace tact::firmware::run {

/// One loop from its first tick to the release of the device.
struct LoopRun {
  const loop::Progress& progress;
  std::function<void()> run;
};

struct GuardedLoop {
  std::vector<LoopRun> runs;  // run one after another, until a stop request
  hal::Device& device;
  hal::SafetyLines& lines;
  loop::Requests& requests;
  watch::CallFilter* filter = nullptr;  // null: any call is allowed
  const guardian::Guardian* guardian = nullptr;
  pc::RtSettings rt;
  std::int64_t period_ns = 0;
  bool hard_real_time = false;
};

class LoopExecutor {
 public:
  explicit LoopExecutor(const GuardedLoop& guarded);
  ~LoopExecutor();
  LoopExecutor(const LoopExecutor&) = delete;
  LoopExecutor& operator=(const LoopExecutor&) = delete;

  bool ended() const { return ended_.load(); }
  /// True 3 s after a stop request if loop or device have not ended. Call a few times a second.
  bool hangs();
  /// After ended(). The error: a thread could not be started, and the loop has not run.
  std::optional<model::Error> join();
  /// After hangs(): drops the lines, stops the device if it still answers, calls `shutdown_frames`,
  /// and exits within 6 s. The kernel then closes all files; drives with a watchdog remove the
  /// force.
  [[noreturn]] void leave_behind(int status, const std::function<void()>& shutdown_frames);
  /// Sum over all runs; call after join().
  const ThreadCosts& costs() const { return costs_; }

 private:
  void run_all();
  std::optional<model::Error> run_one(const LoopRun& one);

  GuardedLoop guarded_;
  watch::RunawayGuard runaway_;
  std::atomic<bool> ended_{false};
  std::int64_t asked_ns_ = 0;  // when the stop request was first seen; 0: not yet
  ThreadCosts costs_;
  std::optional<model::Error> error_;  // of the executor's thread until it has ended
  std::binary_semaphore hung_{0};
  std::atomic<bool> stopped_{false};
  hal::threads::Thread stopper_, executor_;
};

}  // namespace tact::firmware::run
