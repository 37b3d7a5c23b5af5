// SPDX-License-Identifier: Apache-2.0
// fader.h - a level between 0 and 1 that opens and closes at fixed rates. It closes by all periods
// that passed since the last step and opens by one, however late the loop is.
#pragma once

#include "model/rt.h"

namespace tact::firmware::gate {

class Fader {
 public:
  Fader(double close_s, double open_s) : close_s_(close_s), open_s_(open_s) {}

  double step(bool open, double dt_s, double periods = 1.0) RT_SAFE {
    const double moved = level_ + (open ? dt_s / open_s_ : -periods * dt_s / close_s_);
    level_ = moved > 0.0 ? (moved < 1.0 ? moved : 1.0) : 0.0;
    return level_;
  }
  double level() const RT_SAFE { return level_; }
  void set(double level) RT_SAFE { level_ = level; }

 private:
  double close_s_, open_s_;
  double level_ = 1.0;
};

}  // namespace tact::firmware::gate
