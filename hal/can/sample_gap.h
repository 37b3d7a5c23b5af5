// SPDX-License-Identifier: Apache-2.0
// sample_gap.h - scales the torques down while position samples are missing.
//
//     missing samples in a row    0, 1      2 .. n + 1                  n = 10 ms of ticks
//     torque_ratio                   1      falls by 1/n per tick       0 after n + 1
//
// Gravity torques belong to a pose: without news of it they push the arms somewhere. One
// missing sample is normal, as the drives run on clocks of their own; twenty mean that the device
// is lost. When samples come again the ratio rises as it fell.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/rt.h"

namespace tact::hal::can {

class SampleGap {
 public:
  static constexpr int kMaxMissing = 20;

  explicit SampleGap(double period_s)
      : fade_ticks_(std::max(1, static_cast<int>(std::floor(kFade_s / period_s)))),
        left_ticks_(fade_ticks_) {}

  /// Once per tick.
  void step(bool fresh) RT_SAFE {
    missing_ = fresh ? 0 : std::min(missing_ + 1, kMaxMissing);
    const int change = missing_ == 1 ? 0 : (fresh ? 1 : -1);
    left_ticks_ = std::clamp(left_ticks_ + change, 0, fade_ticks_);
  }
  double torque_ratio() const RT_SAFE { return static_cast<double>(left_ticks_) / fade_ticks_; }
  bool is_lost() const RT_SAFE { return missing_ >= kMaxMissing; }

 private:
  static constexpr double kFade_s = 0.010 * (1.0 + 1e-9);  // ten periods of 1 ms are ten

  int fade_ticks_, left_ticks_;
  int missing_ = 0;
};

}  // namespace tact::hal::can
