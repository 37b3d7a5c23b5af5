// SPDX-License-Identifier: Apache-2.0
// overrun_counter.h - when do overruns of the loop latch a fault?
//
//     hard real time   20 periods skipped at once, or 20 late ticks in a row (RT-15)
//     elsewhere        0.3 s skipped at once, or 100 late ticks in a row; shorter stalls are normal
//                      on a stock kernel
//
// A late tick ends after the next release, so at least one period is skipped. A loop that is late
// in every tick is too slow for its rate: each force is held too long, which adds energy.
#pragma once

#include <cmath>
#include <cstdint>

#include "model/rt.h"

namespace tact::firmware::loop {

class OverrunCounter {
 public:
  OverrunCounter(bool hard_real_time, double period_s)
      : hard_real_time_(hard_real_time),
        skipped_in_one_pause_(hard_real_time
                                  ? kSkippedAtOnce
                                  : static_cast<std::uint32_t>(std::lround(kPause_s / period_s))) {}

  /// Call once per tick, with the periods skipped before it. True: stop.
  bool step(std::uint32_t skipped_periods) RT_SAFE {
    if (skipped_periods == 0)
      late_in_a_row_ = 0;
    else if (late_in_a_row_ < kLateInARow)
      ++late_in_a_row_;
    if (skipped_periods >= skipped_in_one_pause_) return true;
    return late_in_a_row_ >= (hard_real_time_ ? kLateInARowHard : kLateInARow);
  }

 private:
  static constexpr std::uint32_t kSkippedAtOnce = 20;
  static constexpr double kPause_s = 0.3;  // a held process: the motion of the hand is unknown
  static constexpr std::uint32_t kLateInARowHard = 20, kLateInARow = 100;

  bool hard_real_time_;
  std::uint32_t skipped_in_one_pause_;
  std::uint32_t late_in_a_row_ = 0;
};

}  // namespace tact::firmware::loop
