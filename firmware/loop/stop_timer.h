// SPDX-License-Identifier: Apache-2.0
// stop_timer.h - when did the force stop, and how long after its cause?
//
// Three times of the loop's clock (CLOCK_MONOTONIC): the first missing sample before the stop, the
// first latched fault, and the write that made the force zero. They show in the report whether a
// stop was in time. If there are several stops, the first fault is reported.
#pragma once

#include <cstdint>

#include "firmware/loop/controller.h"

namespace tact::firmware::loop {

struct StopTimes {
  std::int64_t missed_ns = 0;  // all three: 0 means never
  std::int64_t fault_ns = 0;
  std::int64_t zero_ns = 0;  // first zero force after a force; none since
};

class StopTimer {
 public:
  /// Call once per tick with the times of wake-up and write.
  void step(const TickInput& input, const TickOutput& output, std::int64_t wake_ns,
            std::int64_t written_ns) RT_SAFE {
    if (times_.fault_ns == 0) {  // keeps the samples that were missing at the stop
      if (input.sample.fresh) times_.missed_ns = 0;
      if (!input.sample.fresh && times_.missed_ns == 0) times_.missed_ns = wake_ns;
      if (output.fault != Fault::kNone) times_.fault_ns = wake_ns;
    }
    const bool zero = output.written == model::Wrench{};
    if (!zero) times_.zero_ns = 0;
    if (zero && force_) times_.zero_ns = written_ns;
    force_ = !zero;
  }
  const StopTimes& times() const RT_SAFE { return times_; }

 private:
  StopTimes times_;
  bool force_ = false;
};

}  // namespace tact::firmware::loop
