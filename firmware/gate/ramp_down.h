// SPDX-License-Identifier: Apache-2.0
// ramp_down.h - a level between 0 and 1 that opens and closes at a fixed rate, wholly in ramp_s. It
// closes by all periods that passed since the last step and opens by one, however late the loop is.
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
