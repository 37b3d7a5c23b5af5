// SPDX-License-Identifier: Apache-2.0
// stall_detector.h - has the loop stopped ticking? Pure: reads the loop's progress once per check.
//
// The watch checks every 5 periods. The detector counts checks without a tick, not time: when the
// whole process or PC stood still, neither ran, and the loop detects that case itself
// (overrun_counter.h).
//
//     hard real time   20 periods, as for missing samples and late ticks
//     elsewhere        250 ms, because a stock kernel causes stalls of its own
#pragma once

#include "firmware/loop/progress.h"
#include "model/fault.h"

namespace tact::firmware::watch {

class StallDetector {
 public:
  StallDetector(std::int64_t period_ns, bool hard_real_time)
      : period_ns_(period_ns),
        check_ns_(kPeriodsPerCheck * period_ns),
        limit_ns_(hard_real_time ? kStalledPeriods * period_ns : kStalled_ns),
        most_checks_((limit_ns_ + check_ns_ - 1) / check_ns_) {}

  std::int64_t period_ns() const RT_SAFE { return period_ns_; }
  std::int64_t check_ns() const RT_SAFE { return check_ns_; }
  /// Longest time from the last tick to the fault, when the watch itself runs on time.
  std::int64_t longest_ns() const { return (most_checks_ + 1) * check_ns_; }

  /// One check. Returns the fault at every check of the stall, kNone otherwise.
  model::Fault step(const loop::Progress& progress) RT_SAFE {
    const std::uint64_t ticks = progress.ticks();
    if (ticks != before_ || !progress.running()) {
      before_ = ticks;
      still_ = 0;
      return model::Fault::kNone;
    }
    if (still_ < most_checks_) ++still_;
    if (still_ < most_checks_) return model::Fault::kNone;
    switch (progress.callee()) {
      case loop::Callee::kDevice:
        return model::Fault::kDeviceStalled;
      case loop::Callee::kLines:
        return model::Fault::kLinesLost;
      case loop::Callee::kOwn:
        break;
    }
    return model::Fault::kLoopStalled;
  }

 private:
  static constexpr std::int64_t kPeriodsPerCheck = 5, kStalledPeriods = 20;
  static constexpr std::int64_t kStalled_ns = 250'000'000;

  std::int64_t period_ns_, check_ns_, limit_ns_, most_checks_;
  std::uint64_t before_ = 0;
  std::int64_t still_ = 0;  // checks in a row without a tick
};

}  // namespace tact::firmware::watch
