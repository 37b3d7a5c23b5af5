// bare_loop.h - the loop's grid and sleep without scene and device: what the kernel alone gives.
#pragma once

#include <atomic>
#include <cstdint>

#include "firmware/clock.h"
#include "firmware/ring.h"

namespace tact::tools {

/// The same absolute deadlines as firmware/rt_loop.h; late ticks skip whole periods. Wake, tell and
/// total are measured, all other phases are 0.
class BareLoop {
 public:
  BareLoop(std::int64_t period_ns, std::uint64_t max_periods, firmware::Clock& clock,
           const std::atomic<bool>& stop, firmware::TickRing& ring)
      : period_ns_(period_ns), max_periods_(max_periods), clock_(clock), stop_(stop), ring_(ring) {}

  /// Until the stop flag or max_periods (0: no limit).
  void run() RT_SAFE;

 private:
  void step() RT_SAFE;

  std::int64_t period_ns_;
  std::uint64_t max_periods_;
  firmware::Clock& clock_;
  const std::atomic<bool>& stop_;
  firmware::TickRing& ring_;
  firmware::TickRecord record_{};
  std::int64_t due_ns_ = 0;
  std::uint64_t periods_ = 0;
};

}  // namespace tact::tools
