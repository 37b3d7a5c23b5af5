// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/controller.h"

#include <algorithm>
#include <utility>

#include "firmware/loop/jaw_force.h"

namespace tact::firmware::loop {
namespace {

// A gate that lets go: no force of any law is felt.
bool lets_go(Fault limit) RT_SAFE {
  return limit == Fault::kNotArmed || limit == Fault::kSampleStale ||
         limit == Fault::kOutsideWorkspace || limit == Fault::kTooFast;
}

// More latch on hard real time (overrun_counter.h), and each period that is followed costs time.
constexpr std::uint32_t kMaxPeriods = 20;
// The reach of a tool goes beyond its speed limit by 5 %, as a period may be longer by the jitter
// of the device's samples, and by 0.1 mm, the noise and the steps of its encoders.
constexpr double kReachRatio = 1.05;
constexpr double kReachMargin_m = 1e-4;

// v + w l: the speed limit of the tool, and its turn about its origin at the farthest sphere.
double fastest_sphere_mps(const model::contact::ContactScene& scene, const gate::Gate& gate) {
  double lever_m = 0.0;
  for (const model::contact::ProbeSphere& sphere : scene.spheres)
    lever_m = std::max(lever_m, norm(sphere.offset_m));
  // Without a lever a turn moves nothing, even where it has no limit.
  return gate.speed_limit_mps() + (lever_m > 0.0 ? gate.turn_limit_radps() * lever_m : 0.0);
}

}  // namespace

Controller::Controller(const model::contact::ContactScene& scene, const gate::Gate& gate,
                       bool hard_real_time, const std::optional<gate::GripGate>& grip_gate)
    : contact_(scene),
      gate_(gate),
      grip_gate_(grip_gate),
      overruns_(hard_real_time),
      fastest_mps_(fastest_sphere_mps(scene, gate)) {}

// In the periods since the last sample, or in the time between both samples: a tick that woke late
// has a sample of then, and what was skipped is told in the next one.
double Controller::reach_m(std::uint64_t periods, std::int64_t stamp_ns) const RT_SAFE {
  const double by_ticks_s = static_cast<double>(periods) * gate_.period_s();
  const double by_stamps_s = seen_ ? 1e-9 * static_cast<double>(stamp_ns - stamp_ns_) : 0.0;
  return kReachRatio * fastest_mps_ * std::max(by_ticks_s, by_stamps_s) + kReachMargin_m;
}

// Neither arming nor a pause changes contact: it follows the tool from its first sample on. While
// samples are missing it stays where the last one was.
void Controller::detect_contact(const TickInput& input) RT_SAFE {
  const std::uint64_t passed = std::uint64_t{input.skipped_periods} + 1;  // since the last tick
  const auto periods = static_cast<std::uint32_t>(std::min<std::uint64_t>(passed, kMaxPeriods));
  const hal::Sample& sample = input.sample;
  const bool is_open = input.clutch == ClutchState::kOpen;
  // The tool stays, and touches nothing: what comes after begins where it is then.
  if (is_open && !std::exchange(was_open_, is_open)) contact_.reset();
  was_open_ = is_open;
  if (is_open) {
    if (sample.fresh) stamp_ns_ = sample.stamp_ns;
  } else if (sample.fresh) {
    contact_.detect_contact(sample.tool, periods, reach_m(unseen_ + passed, sample.stamp_ns));
    stamp_ns_ = sample.stamp_ns;
    seen_ = true;
    unseen_ = 0;
  } else if (seen_) {
    contact_.detect_contact(sample.tool, periods);
    unseen_ += passed;
  }
}

void Controller::render_force(const TickInput& input) RT_SAFE {
  if (!seen_) return;  // before the first sample there is no pose
  // A blade cuts only what a hand can feel: armed, as the tick before left it.
  const bool is_open = input.clutch == ClutchState::kOpen;
  rendered_ = contact_.render_force(input.sample.tool, supervisor_.armed() && !is_open);
  if (rendered_.is_lost) ++contact_losses_;
  jaw_force_N_ = jaw_force_N(contact_.contacts(), input.sample.tool.grip_ratio);
}

void Controller::publish_shape() RT_SAFE {
  if (contact_.shape(shape_)) shapes_.write(shape_);
}

// The device's own word counts first, then what the samples, the law and the clock tell.
Fault Controller::find_fault(const TickInput& input, bool finite, bool too_late) const RT_SAFE {
  if (latches(input.device_fault)) return input.device_fault;
  if (!finite) return Fault::kSampleNotFinite;
  if (rendered_.is_broken) return Fault::kLawBroke;
  // Late without a force harms nobody; a start may take its time.
  if (too_late && supervisor_.armed()) return Fault::kLoopLate;
  return Fault::kNone;
}

// A force that is no longer the tissue's is told before what the gate does with it, unless the gate
// lets go. A loss is told then, too: what makes it, missed samples and jumps, often makes the gate
// let go. A person must learn before arming that the tool is inside.
Fault Controller::find_limit(Fault acting, bool is_coupled) const RT_SAFE {
  const bool open = !lets_go(acting);
  const State state = supervisor_.state();
  if (rendered_.is_lost && state == State::kArmed) return Fault::kContactLost;
  if (!is_coupled) return Fault::kClutchPressed;
  if (rendered_.is_inside && (open || state == State::kOff || state == State::kReady))
    return Fault::kToolInside;
  if ((rendered_.is_saturated || rendered_.is_unsettled) && open) return Fault::kLawSaturated;
  return acting;
}

// Where the gate lets the hand go, it lets the fingers go, too.
gate::LimitedGrip Controller::limit_grip(const TickInput& input) RT_SAFE {
  if (!grip_gate_) return {};
  const hal::Sample& sample = input.sample;
  return grip_gate_->limit(
      {.wanted_N = lets_go(acting_) || input.clutch != ClutchState::kCoupled ? 0.0 : jaw_force_N_,
       .gap_m = sample.grip_gap_m,
       .speed_mps = sample.grip_speed_mps,
       .fresh = sample.fresh,
       .armed = supervisor_.armed(),
       .skipped_periods = input.skipped_periods});
}

TickOutput Controller::limit(const TickInput& input) RT_SAFE {
  const bool finite = is_finite(input.sample.tool);
  const bool too_late = overruns_.step(input.skipped_periods);
  const Fault fault = find_fault(input, finite, too_late);
  // The supervisor before the gate: a fault found in this tick has zero force in this tick.
  supervisor_.step(
      input.commands,
      {.sample_good = input.sample.fresh && finite, .ready = input.ready, .fault = fault});
  // The fingers first: a fault found there has zero force on the hand in this tick.
  const gate::LimitedGrip grip = limit_grip(input);
  supervisor_.trip(grip.fault);
  // Where the gate latches it makes the force zero by itself; the state follows.
  // Its workspace is the device's, so it is given the handle.
  hal::Tool handle = input.sample.tool;
  handle.position_m = handle.position_m - input.clutch_shift_m;
  const bool is_coupled = input.clutch == ClutchState::kCoupled;
  const gate::LimitedForce verdict =
      gate_.limit({.wanted = is_coupled ? rendered_.wrench : model::Wrench{},
                   .tool = handle,
                   .fresh = input.sample.fresh,
                   .armed = supervisor_.armed(),
                   .skipped_periods = input.skipped_periods});
  supervisor_.trip(verdict.fault);
  acting_ = verdict.acting;
  const Fault acting = verdict.acting != Fault::kNone ? verdict.acting : grip.acting;
  newest_ = {.wanted = rendered_.wrench,
             .written = verdict.wrench,
             .state = supervisor_.state(),
             .limit = find_limit(acting, is_coupled),
             .fault = supervisor_.fault(),
             .given_energy_J = gate_.given_energy_J(),
             .rms_force_N = gate_.rms_force_N(),
             .contact_losses = contact_losses_,
             .wanted_grip_N = grip_gate_ ? jaw_force_N_ : 0.0,
             .written_grip_N = latches(verdict.fault) ? 0.0 : grip.force_N};
  return newest_;
}

}  // namespace tact::firmware::loop
