// SPDX-License-Identifier: Apache-2.0
// paced_clock.h - a loop beside a program that runs in real time, on a machine that may be busy.
#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/loop/clock.h"
#include "model/rt.h"

namespace tact::tests {

/// For the loop a tick takes no time and no deadline is missed. It follows real time: after a time
/// without the core its ticks take half a period each, until it has caught up.
class PacedClock final : public firmware::loop::Clock {
 public:
  std::int64_t now_ns() RT_SAFE override {
    if (now_ns_ == 0) now_ns_ = real_.now_ns();
    return now_ns_;
  }
  void sleep_until_ns(std::int64_t deadline_ns) RT_SAFE override {
    const std::int64_t half_ns = std::max<std::int64_t>(deadline_ns - now_ns(), 0) / 2;
    real_.sleep_until_ns(std::max(deadline_ns, real_.now_ns() + half_ns));
    now_ns_ = std::max(now_ns_, deadline_ns);
  }

 private:
  firmware::loop::MonotonicClock real_;
  std::int64_t now_ns_ = 0;
};

}  // namespace tact::tests
