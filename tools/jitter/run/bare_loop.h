// SPDX-License-Identifier: Apache-2.0
// bare_loop.h - the loop's grid and sleep without scene and device: what the kernel alone gives.
#pragma once

#include <atomic>
#include <cstdint>

#include "firmware/loop/clock.h"
#include "firmware/loop/ring.h"

namespace tact::tools::jitter {

/// The same absolute deadlines as firmware/loop/rt_loop.h; late ticks skip whole periods. Wake,
/// publish and total are measured, all other phases are 0.
class BareLoop {
 public:
  BareLoop(std::int64_t period_ns, std::uint64_t max_periods, firmware::loop::Clock& clock,
           const std::atomic<bool>& stop, firmware::loop::TickRing& ring)
      : period_ns_(period_ns), max_periods_(max_periods), clock_(clock), stop_(stop), ring_(ring) {}

  /// Until the stop flag or max_periods (0: no limit).
  void run() RT_SAFE;

 private:
  void step() RT_SAFE;

  std::int64_t period_ns_;
  std::uint64_t max_periods_;
  firmware::loop::Clock& clock_;
  const std::atomic<bool>& stop_;
  firmware::loop::TickRing& ring_;
  firmware::loop::TickRecord record_{};
  std::int64_t due_ns_ = 0;
  std::uint64_t periods_ = 0;
};

}  // namespace tact::tools::jitter
