// SPDX-License-Identifier: Apache-2.0
// loop_back.h - input to force as a wire shows it: the scope line, which is up from before the
// device is read until the force is written, comes back on a second line, whose edges the kernel
// stamps in its interrupt.
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "hal/gpio/edge_monitor.h"
#include "hal/threads/thread.h"
#include "tools/jitter/statistics/tick_times.h"

namespace tact::tools::jitter {

/// From edges to pulses. A rise without its fall, and a pulse longer than a period, come of edges
/// that were lost: counted, and in no histogram.
class PulseMeter {
 public:
  explicit PulseMeter(std::int64_t period_ns) : period_ns_(period_ns) {}

  void add(const hal::gpio::Edge& edge);
  const Series& pulses() const { return pulses_; }
  std::uint64_t unpaired() const { return unpaired_; }

 private:
  std::int64_t period_ns_;
  std::optional<std::int64_t> rose_ns_;
  Series pulses_;
  std::uint64_t unpaired_ = 0;
};

/// A thread of its own that reads edges until it is stopped.
class LoopBack {
 public:
  static model::Result<std::unique_ptr<LoopBack>> start(
      std::unique_ptr<hal::gpio::EdgeMonitor> edges, std::int64_t period_ns);
  ~LoopBack();
  LoopBack(const LoopBack&) = delete;
  LoopBack& operator=(const LoopBack&) = delete;

  /// Ends the thread and gives what it has measured.
  PulseMeter stop();

 private:
  LoopBack(std::unique_ptr<hal::gpio::EdgeMonitor> edges, std::int64_t period_ns)
      : edges_(std::move(edges)), meter_(period_ns) {}

  std::unique_ptr<hal::gpio::EdgeMonitor> edges_;
  PulseMeter meter_;
  std::atomic<bool> ending_{false};
  hal::threads::Thread thread_;
};

}  // namespace tact::tools::jitter
