// SPDX-License-Identifier: Apache-2.0
// sample_gap.h - scales the torques down while position samples are missing.
//
//     missing samples in a row    0, 1      2 and more
//     torque_ratio                   1      falls to 0 in 10 ms, also where periods are skipped
//
// Gravity torques belong to a pose: without news of it they push the arms somewhere. One
// missing sample is normal, as the drives run on clocks of their own; twenty mean that the device
// is lost. When samples come again the ratio rises as it fell.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "model/limits.h"
#include "model/rt.h"
#include "model/time_ns.h"

namespace tact::hal::can {

class SampleGap {
 public:
  static constexpr int kMaxMissing = model::kLostAfterSamples;

  explicit SampleGap(double rate_Hz)
      : period_ns_(model::period_ns(rate_Hz)),
        ramp_periods_(std::max<std::int64_t>(1, std::llround(std::floor(kRampDown_s * rate_Hz)))),
        left_periods_(ramp_periods_) {}

  /// Once per tick; `elapsed_ns`: since the tick before, rounded to periods, at least one.
  void step(bool fresh, std::int64_t elapsed_ns) RT_SAFE {
    const std::int64_t periods =
        std::max<std::int64_t>(1, (elapsed_ns + period_ns_ / 2) / period_ns_);
    missing_ = fresh ? 0 : std::min(missing_ + 1, kMaxMissing);
    const std::int64_t change = missing_ == 1 ? 0 : (fresh ? periods : -periods);
    left_periods_ = std::clamp<std::int64_t>(left_periods_ + change, 0, ramp_periods_);
  }
  double torque_ratio() const RT_SAFE {
    return static_cast<double>(left_periods_) / static_cast<double>(ramp_periods_);
  }
  bool is_lost() const RT_SAFE { return missing_ >= kMaxMissing; }

 private:
  // Ten periods of 1 ms are ten.
  static constexpr double kRampDown_s = model::kStaleRampDown_s * (1.0 + 1e-9);

  std::int64_t period_ns_, ramp_periods_, left_periods_;
  int missing_ = 0;
};

}  // namespace tact::hal::can
