// SPDX-License-Identifier: Apache-2.0
// supervisor.h - state machine that permits force: Off, Ready, Armed, Stopped; latches faults.
//
//     Off      no good sample yet             -> Ready    a good sample
//     Ready    device good, tissue force zero -> Armed    rising edge of arm, good sample, power on
//     Armed    force passes the gate          -> Stopped  power lost
//                                             -> Ready    rising edge of disarm
//     Stopped  force zero, fault kept         -> Ready    rising edge of reset, good sample, no
//                                                         fault that latches, no arm request
//     any                                     -> Stopped  stop request, or a fault that latches
//
// The gate writes zero force except in Armed; gravity compensation of the device may act while its
// drives have power. Reset never arms: arming needs a separate request (RT-16). A request before
// Ready or without power is dropped, not kept for later. Nothing arms while disarm is requested.
#pragma once

#include "firmware/loop/state.h"
#include "model/fault.h"

namespace tact::firmware::loop {

using model::Fault;

/// Requests of a person; levels, sampled once per tick.
struct Commands {
  bool arm = false;
  bool stop = false;
  bool reset = false;
  bool disarm = false;

  friend bool operator==(const Commands&, const Commands&) = default;
};

/// Results of the checks of a tick.
struct Findings {
  bool sample_good = false;
  bool ready = true;           // power is on and the motors work
  Fault fault = Fault::kNone;  // of the lines, the device, its sample, the law or the clock
};

class Supervisor {
 public:
  /// Call once per tick.
  State step(const Commands& commands, const Findings& found) RT_SAFE;

  /// Reports a fault found after step(): if it latches, the state becomes Stopped in this tick.
  void trip(Fault fault) RT_SAFE;

  State state() const RT_SAFE { return state_; }
  /// The latched fault; kNone after a stop request.
  Fault fault() const RT_SAFE { return fault_; }
  bool armed() const RT_SAFE { return state_ == State::kArmed; }

 private:
  State state_ = State::kOff;
  Fault fault_ = Fault::kNone;
  bool arm_before_ = false, reset_before_ = false, disarm_before_ = false;
};

}  // namespace tact::firmware::loop
