// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/controller.h"

#include <algorithm>
#include <utility>

#include "firmware/loop/jaw_force.h"

namespace tact::firmware::loop {
namespace {

// The gate ramps down or has zero force, for this reason.
bool is_ramped_down(Fault limit) RT_SAFE {
  return limit == Fault::kNotArmed || limit == Fault::kSampleStale ||
         limit == Fault::kOutsideWorkspace || limit == Fault::kTooFast;
}

// Periods simulated in one tick, which cost time. With hard real time 20 skipped periods latch.
constexpr std::uint32_t kMaxPeriods = 20;
// Margins on the distance that the speed limit permits: 5 % for the jitter of the device's
// samples, 0.1 mm for noise and resolution of the encoders.
constexpr double kReach_ratio = 1.05;
constexpr double kReachMargin_m = 1e-4;

// v + w l: speed limit of the tool, turn limit times the distance of the farthest sphere.
double fastest_sphere_mps(const model::contact::ContactScene& scene, const gate::Gate& gate) {
  double lever_m = 0.0;
  for (const model::contact::ProbeSphere& sphere : scene.spheres)
    lever_m = std::max(lever_m, norm(sphere.offset_m));
  // Without a lever a rotation moves no sphere, even if the turn limit is infinite.
  return gate.speed_limit_mps() + (lever_m > 0.0 ? gate.turn_limit_radps() * lever_m : 0.0);
}

}  // namespace

Controller::Controller(const model::contact::ContactScene& scene, const gate::Gate& gate,
                       bool hard_real_time, const std::optional<gate::GripGate>& grip_gate)
    : own_contact_(scene),
      gate_(gate),
      grip_gate_(grip_gate),
      overruns_(hard_real_time, gate.period_s()),
      fastest_mps_(fastest_sphere_mps(scene, gate)) {}

// The longer of the periods since the last sample and of the time between both time stamps: in a
// tick that woke late the sample is late, too, but the skipped periods count only in the next tick.
double Controller::reach_m(std::uint64_t periods, std::int64_t stamp_ns) const RT_SAFE {
  const double by_ticks_s = static_cast<double>(periods) * gate_.period_s();
  const double by_stamps_s = seen_ ? 1e-9 * static_cast<double>(stamp_ns - stamp_ns_) : 0.0;
  return kReach_ratio * fastest_mps_ * std::max(by_ticks_s, by_stamps_s) + kReachMargin_m;
}

// Contact follows the tool from the first sample on, armed or not. While samples are missing the
// tool stays at the last one.
void Controller::detect_contact(const TickInput& input) RT_SAFE {
  const std::uint64_t passed = std::uint64_t{input.skipped_periods} + 1;  // since the last tick
  const auto periods = static_cast<std::uint32_t>(std::min<std::uint64_t>(passed, kMaxPeriods));
  const hal::Sample& sample = input.sample;
  const bool is_open = input.clutch == ClutchState::kOpen;
  // Opening the clutch resets contact; after release contact starts again at the tool's position.
  if (is_open && !std::exchange(was_open_, is_open)) contact_->reset();
  was_open_ = is_open;
  if (is_open) {
    if (sample.fresh) stamp_ns_ = sample.stamp_ns;
  } else if (sample.fresh) {
    contact_->detect_contact(sample.tool, periods, reach_m(unseen_ + passed, sample.stamp_ns));
    stamp_ns_ = sample.stamp_ns;
    seen_ = true;
    unseen_ = 0;
  } else if (seen_) {
    contact_->detect_contact(sample.tool, periods);
    unseen_ += passed;
  }
}

void Controller::render_force(const TickInput& input) RT_SAFE {
  if (!seen_) return;  // before the first sample there is no pose
  // The blade cuts only while force can be rendered: armed after the last tick, clutch closed.
  const bool is_open = input.clutch == ClutchState::kOpen;
  rendered_ = contact_->render_force(input.sample.tool, supervisor_.armed() && !is_open);
  if (rendered_.is_lost) ++contact_losses_;
  jaw_force_N_ = jaw_force_N(contact_->contacts(), input.sample.tool.grip_ratio);
}

void Controller::publish_shape() RT_SAFE {
  if (contact_->shape(shape_)) shapes_.write(shape_);
}

// A latched fault of the device comes first, then sample, law and lateness.
Fault Controller::find_fault(const TickInput& input, bool finite, bool too_late) const RT_SAFE {
  if (latches(input.device_fault)) return input.device_fault;
  if (!finite) return Fault::kSampleNotFinite;
  if (rendered_.is_broken) return Fault::kLawBroke;
  // Overruns count only while armed: without force they are harmless, and the start is slow.
  if (too_late && supervisor_.armed()) return Fault::kLoopLate;
  return Fault::kNone;
}

// Limits of contact and law are reported before those of the gate, unless the gate has ramped down
// or is not armed (is_ramped_down). Lost contact is reported in any case while armed, because its
// causes, missed samples and jumps, also ramp the gate down. "Tool inside" is reported before
// arming, too.
Fault Controller::find_limit(Fault acting, bool is_coupled) const RT_SAFE {
  const bool open = !is_ramped_down(acting);
  const State state = supervisor_.state();
  if (rendered_.is_lost && state == State::kArmed) return Fault::kContactLost;
  if (!is_coupled) return Fault::kClutchPressed;
  if (rendered_.is_inside && (open || state == State::kOff || state == State::kReady))
    return Fault::kToolInside;
  if ((rendered_.is_saturated || rendered_.is_unsettled) && open) return Fault::kLawSaturated;
  return acting;
}

// If the gate of the hand ramps down, the wanted force on the fingers is zero, too.
gate::LimitedGrip Controller::limit_grip(const TickInput& input) RT_SAFE {
  if (!grip_gate_) return {};
  const hal::Sample& sample = input.sample;
  return grip_gate_->limit(  // bound: grips a call (1 with a gripper that has a motor, else 0)
      {.wanted_N =
           is_ramped_down(acting_) || input.clutch != ClutchState::kCoupled ? 0.0 : jaw_force_N_,
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
  // The supervisor runs before the gate: a fault zeroes the force in the same tick.
  supervisor_.step(
      input.commands,
      {.sample_good = input.sample.fresh && finite, .ready = input.ready, .fault = fault});
  // The grip gate runs before the gate: its fault zeroes the force on the hand in the same tick.
  const gate::LimitedGrip grip = limit_grip(input);
  supervisor_.trip(grip.fault);
  // If the gate latches, it zeroes the force; the supervisor then stops. The gate's workspace is
  // that of the device, so the gate gets the pose of the handle.
  hal::Tool handle = input.sample.tool;
  handle.position_m = handle.position_m - input.clutch_shift_m;
  const bool is_coupled = input.clutch == ClutchState::kCoupled;
  const gate::LimitedForce limited =
      gate_.limit({.wanted = is_coupled ? rendered_.wrench : model::Wrench{},
                   .tool = handle,
                   .fresh = input.sample.fresh,
                   .armed = supervisor_.armed(),
                   .skipped_periods = input.skipped_periods});
  supervisor_.trip(limited.fault);
  acting_ = limited.acting;
  const Fault acting = limited.acting != Fault::kNone ? limited.acting : grip.acting;
  newest_ = {.wanted = rendered_.wrench,
             .written = limited.wrench,
             .state = supervisor_.state(),
             .limit = find_limit(acting, is_coupled),
             .fault = supervisor_.fault(),
             .given_energy_J = gate_.given_energy_J(),
             .rms_force_N = gate_.rms_force_N(),
             .contact_losses = contact_losses_,
             .wanted_grip_N = grip_gate_ ? jaw_force_N_ : 0.0,
             .written_grip_N = latches(limited.fault) ? 0.0 : grip.force_N};
  return newest_;
}

}  // namespace tact::firmware::loop
