// SPDX-License-Identifier: Apache-2.0
// ramp_down.h - a factor between 0 and 1 that ramps up and down within ramp_s. A step down covers
// all periods since the last step, a step up one period, also after skipped periods.
#pragma once

#include "model/rt.h"

namespace tact::firmware::gate {

class RampDown {
 public:
  explicit RampDown(double ramp_s) : ramp_s_(ramp_s) {}

  double step(bool open, double dt_s, double periods = 1.0) RT_SAFE {
    const double moved = level_ + (open ? dt_s / ramp_s_ : -periods * dt_s / ramp_s_);
    level_ = moved > 0.0 ? (moved < 1.0 ? moved : 1.0) : 0.0;
    return level_;
  }
  double level() const RT_SAFE { return level_; }
  void set(double level) RT_SAFE { level_ = level; }

 private:
  double ramp_s_;
  double level_ = 1.0;
};

}  // namespace tact::firmware::gate
