// SPDX-License-Identifier: Apache-2.0
// stop_timer.h - when did force stop, and how soon after its cause was seen?
//
// Three times of the clock of the loop (CLOCK_MONOTONIC): the first of the samples missing now, the
// fault that latched first, and the write that made the force zero. For the report, and for any
// user has to show that a stop was in time. Of several stops the first fault is told.
#pragma once

#include <cstdint>

#include "firmware/loop/controller.h"

namespace tact::firmware::loop {

struct StopTimes {
  std::int64_t missed_ns = 0;  // 0: never, in all three
  std::int64_t fault_ns = 0;
  std::int64_t zero_ns = 0;  // force left the device; no force since
};

class StopTimer {
 public:
  /// One tick: woken, and its force written.
  void step(const TickInput& input, const TickOutput& output, std::int64_t wake_ns,
            std::int64_t written_ns) RT_SAFE {
    if (times_.fault_ns == 0) {  // which samples were missing when it stopped
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
