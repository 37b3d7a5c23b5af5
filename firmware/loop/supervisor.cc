// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/supervisor.h"

namespace tact::firmware::loop {

State Supervisor::step(const Commands& commands, const Findings& found) RT_SAFE {
  const bool arm_edge = commands.arm && !arm_before_;
  const bool reset_edge = commands.reset && !reset_before_;
  const bool disarm_edge = commands.disarm && !disarm_before_;
  arm_before_ = commands.arm;
  disarm_before_ = commands.disarm;
  reset_before_ = commands.reset;
  // Levels are stored in every state, so a request that came too early is dropped (RT-16). A fault
  // is handled before a stop request, so that it is reported as the cause.
  trip(found.fault);
  if (commands.stop) return state_ = State::kStopped;
  switch (state_) {
    case State::kOff:
      if (found.sample_good) state_ = State::kReady;
      break;
    case State::kReady:
      if (arm_edge && found.sample_good && found.ready && !commands.disarm) state_ = State::kArmed;
      break;
    case State::kArmed:  // latches, so that no force returns with the power
      if (!found.ready)
        trip(Fault::kPowerLost);
      else if (disarm_edge)
        state_ = State::kReady;
      break;
    // Reset and arm are two requests: no reset while arm is requested.
    case State::kStopped:
      if (reset_edge && found.sample_good && !latches(found.fault) && !commands.arm) {
        state_ = State::kReady;
        fault_ = Fault::kNone;
      }
      break;
  }
  return state_;
}

void Supervisor::trip(Fault fault) RT_SAFE {
  if (!latches(fault)) return;
  if (fault_ == Fault::kNone) fault_ = fault;  // the first one is the cause
  state_ = State::kStopped;
}

}  // namespace tact::firmware::loop
