// SPDX-License-Identifier: Apache-2.0
// suspend_detector.h - was the PC suspended since the last check? The loop cannot see it: its
// clock, CLOCK_MONOTONIC, stops meanwhile; CLOCK_BOOTTIME goes on.
#pragma once

#include <cstdint>

#include "model/rt.h"
#include "model/time_ns.h"

namespace tact::firmware::watch {

class SuspendDetector {
 public:
  /// `ahead_ns`: of CLOCK_BOOTTIME over CLOCK_MONOTONIC. True once for each suspension.
  bool step(std::int64_t ahead_ns) RT_SAFE {
    const bool is_longer = before_ns_ >= 0 && ahead_ns - before_ns_ > kPause_ns;
    before_ns_ = ahead_ns;
    return is_longer;
  }

 private:
  static constexpr std::int64_t kPause_ns = 300 * model::kMillisecond_ns;  // as OverrunCounter's
  std::int64_t before_ns_ = -1;
};

}  // namespace tact::firmware::watch
