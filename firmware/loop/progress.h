// SPDX-License-Identifier: Apache-2.0
// progress.h - progress of the loop, written by the loop, read by the watch (loop_monitor.h).
//
// The loop only makes relaxed stores, a few per tick, and never waits.
#pragma once

#include <atomic>
#include <cstdint>

#include "model/rt.h"

namespace tact::firmware::loop {

/// Whose code the loop is running; names the cause if a call hangs.
enum class Callee : std::uint8_t { kOwn, kLines, kDevice };

class Progress {
 public:
  /// Loop side.
  void tick() RT_SAFE {
    ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  void enter(Callee callee) RT_SAFE { callee_.store(callee, std::memory_order_relaxed); }
  /// Zero force is written and the loop makes no further call.
  void end() RT_SAFE { ended_.store(true, std::memory_order_relaxed); }

  /// Watch side.
  std::uint64_t ticks() const RT_SAFE { return ticks_.load(std::memory_order_relaxed); }
  Callee callee() const RT_SAFE { return callee_.load(std::memory_order_relaxed); }
  bool running() const RT_SAFE { return ticks() > 0 && !ended_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<Callee> callee_{Callee::kOwn};
  std::atomic<bool> ended_{false};
};

}  // namespace tact::firmware::loop
