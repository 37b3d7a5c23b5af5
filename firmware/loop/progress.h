// SPDX-License-Identifier: Apache-2.0
// progress.h - where the loop is, told by the loop, read by the watch above it (loop_monitor.h).
//
// Plain stores on the loop's side: a tick costs a handful of them, and never waits.
#pragma once

#include <atomic>
#include <cstdint>

#include "model/rt.h"

namespace tact::firmware::loop {

/// Whose code runs: a call that does not come back names its owner.
enum class Callee : std::uint8_t { kOwn, kLines, kDevice };

class Progress {
 public:
  /// Loop side.
  void tick() RT_SAFE {
    ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  void enter(Callee callee) RT_SAFE { callee_.store(callee, std::memory_order_relaxed); }
  /// The force is zero and nothing follows.
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
