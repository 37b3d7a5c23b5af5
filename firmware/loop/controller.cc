// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/controller.h"

namespace tact::firmware::loop {
namespace {

// A gate that lets go: no force of any law is felt.
bool lets_go(Fault limit) RT_SAFE {
  return limit == Fault::kNotArmed || limit == Fault::kSampleStale ||
         limit == Fault::kOutsideWorkspace || limit == Fault::kTooFast;
}

}  // namespace

// A tool that moved unseen starts anew: whatever depth it has by then comes without force.
void Controller::touch(const TickInput& input) RT_SAFE {
  unseen_ += input.skipped_periods;
  // One period unseen is what the gate holds, too (RT-15); after two the tool may be anywhere.
  if (input.sample.fresh && unseen_ >= 2) contact_.reset();
  unseen_ = input.sample.fresh ? 0 : unseen_ + 1;
  contact_.touch(input.sample.tool);
}

void Controller::feel(const TickInput& input) RT_SAFE {
  // A blade cuts only what a hand can feel: armed, as the tick before left it.
  felt_ = contact_.feel(input.sample.tool, supervisor_.armed());
}

void Controller::tell_shape() RT_SAFE {
  if (contact_.shape(shape_)) shapes_.write(shape_);
}

// The device's own word counts first, then what the samples, the law and the clock tell.
Fault Controller::find_fault(const TickInput& input, bool finite, bool too_late) const RT_SAFE {
  if (latches(input.device_fault)) return input.device_fault;
  if (!finite) return Fault::kSampleNotFinite;
  if (felt_.is_broken) return Fault::kLawBroke;
  // Late without a force harms nobody; a start may take its time.
  if (too_late && supervisor_.armed()) return Fault::kLoopLate;
  return Fault::kNone;
}

TickOutput Controller::judge(const TickInput& input) RT_SAFE {
  const bool finite = is_finite(input.sample.tool);
  const bool too_late = late_watch_.step(input.skipped_periods);
  const Fault fault = find_fault(input, finite, too_late);
  // The supervisor before the gate: a fault found in this tick has zero force in this tick.
  const bool armed_before = supervisor_.armed();
  supervisor_.step(
      input.commands,
      {.sample_good = input.sample.fresh && finite, .ready = input.ready, .fault = fault});
  if (supervisor_.armed() && !armed_before) {  // arming inside the organ pushes nothing
    contact_.reset();
    felt_ = {};
  }

  // Where the gate latches it makes the force zero by itself; the state follows.
  const gate::GateVerdict verdict = gate_.judge({.wanted = felt_.wrench,
                                                 .tool = input.sample.tool,
                                                 .fresh = input.sample.fresh,
                                                 .armed = supervisor_.armed(),
                                                 .skipped_periods = input.skipped_periods});
  supervisor_.trip(verdict.fault);
  Fault limit = verdict.acting;
  // A force that is no longer the tissue's is told before what the gate does with it.
  if (felt_.is_saturated && !lets_go(limit)) limit = Fault::kLawSaturated;
  newest_ = {.wanted = felt_.wrench,
             .written = verdict.wrench,
             .state = supervisor_.state(),
             .limit = limit,
             .fault = supervisor_.fault(),
             .given_energy_J = gate_.given_energy_J(),
             .rms_force_N = gate_.rms_force_N()};
  return newest_;
}

}  // namespace tact::firmware::loop
