// SPDX-License-Identifier: Apache-2.0
// supervisor.h - who may feel force: Off -> Ready -> Armed -> Stopped, faults latched.
//
//     Off      nothing known of the device    -> Ready    a good sample
//     Ready    device good, tissue force zero -> Armed    rising edge of arm, good sample, power on
//     Armed    force passes the gate          -> Stopped  power lost
//                                             -> Ready    rising edge of disarm
//     Stopped  force zero, fault kept         -> Ready    rising edge of reset, good sample, no
//                                                         fault that latches, no arm request
//     any                                     -> Stopped  stop request, or a fault that latches
//
// What the gate writes is zero but in Armed; the device may carry its own weight while its drives
// have power. Reset never re-arms: arming is a request of its own (RT-16). A request that comes
// before Ready, or while there is no power, is spent: none is kept for later. Nothing arms while a
// request to disarm stands.
#pragma once

#include "firmware/loop/state.h"
#include "model/fault.h"

namespace tact::firmware::loop {

using model::Fault;

/// What people ask for; levels, sampled once per tick.
struct Commands {
  bool arm = false;
  bool stop = false;
  bool reset = false;
  bool disarm = false;

  friend bool operator==(const Commands&, const Commands&) = default;
};

/// What a tick found out before it decides.
struct Findings {
  bool sample_good = false;
  bool ready = true;           // a force would reach the hand
  Fault fault = Fault::kNone;  // of the lines, the device, its sample, the law or the clock
};

class Supervisor {
 public:
  /// One tick.
  State step(const Commands& commands, const Findings& found) RT_SAFE;

  /// A fault found after step in the same tick: stops at once if it latches.
  void trip(Fault fault) RT_SAFE;

  State state() const RT_SAFE { return state_; }
  /// The fault that stopped it; kNone after a stop request.
  Fault fault() const RT_SAFE { return fault_; }
  bool armed() const RT_SAFE { return state_ == State::kArmed; }

 private:
  State state_ = State::kOff;
  Fault fault_ = Fault::kNone;
  bool arm_before_ = false, reset_before_ = false, disarm_before_ = false;
};

}  // namespace tact::firmware::loop
