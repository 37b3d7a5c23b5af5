// SPDX-License-Identifier: Apache-2.0
#include "firmware/gate/gate.h"

#include <algorithm>
#include <cmath>

#include "firmware/gate/workspace.h"

namespace tact::firmware::gate {
namespace {

using model::kStaleRampDown_s;
using model::slew_beside_ramp_N;

// Chosen: slower than the ramp-down for missed samples, as the device works.
constexpr double kWorkspaceRampDown_s = 0.050;
constexpr std::int64_t kLostAfter = model::kLostAfterSamples;
// The margin of 1/4 lets the tool accelerate while the force falls at the slew limit:
//
//     GT-5   power   F . v + T . w <= 3/4 P
constexpr double kPowerAim_ratio = 0.75;

Wrench operator*(double share, const Wrench& w) RT_SAFE {
  return {share * w.force_N, share * w.torque_Nm};
}

/// Power from the device to the hand; negative: from the hand to the device.
double power_W(const Wrench& w, const model::Tool& tool) RT_SAFE {
  return dot(w.force_N, tool.velocity_mps) + dot(w.torque_Nm, tool.angular_velocity_radps);
}

/// The slew of the brake is the part of the slew limit that the ramp does not use.
EnergyTankSettings tank_settings(const model::Limits& limits, double force_limit_N, double lever_m,
                                 double period_s) {
  return {.budget_J = limits.energy_J,
          .recovery_W = limits.recovery_W,
          .speed_mps = limits.speed_mps,
          .turn_radps = limits.turn_radps,
          .force_limit_N = force_limit_N,
          .lever_m = lever_m,
          .slew_N_per_s = slew_beside_ramp_N(limits, force_limit_N, period_s) / period_s,
          .period_s = period_s};
}

/// A scene gives the continuous force only; continuous torque / peak torque is the same ratio.
ThermalLimit thermal_limit(const model::Limits& limits, double peak, double period_s) {
  const double share =
      limits.force_N > 0.0 ? std::fmin(limits.continuous_force_N / limits.force_N, 1.0) : 1.0;
  return {peak, share * peak, period_s / limits.thermal_time_s};
}

// The first fault of a tick is kept: it is the cause of the others.
void latch_first(Fault fault, LimitedForce& limited) RT_SAFE {
  if (!latches(limited.fault)) limited.fault = fault;
}

}  // namespace

Gate::Gate(const model::Limits& limits, double period_s, double force_share)
    : limits_(limits),
      period_s_(period_s),
      force_limit_N_(model::limits_in_use(limits, force_share).force_N),
      torque_limit_Nm_(model::limits_in_use(limits, force_share).torque_Nm),
      lever_m_(force_limit_N_ > 0.0 ? torque_limit_Nm_ / force_limit_N_ : 0.0),
      force_step_N_(slew_beside_ramp_N(limits, force_limit_N_, period_s)),
      torque_step_Nm_(lever_m_ * force_step_N_),
      fresh_(kStaleRampDown_s),
      workspace_(kWorkspaceRampDown_s),
      speed_(kWorkspaceRampDown_s),
      ramp_(limits.ramp_s),
      tank_(tank_settings(limits, force_limit_N_, lever_m_, period_s)),
      thermal_force_(thermal_limit(limits, force_limit_N_, period_s)),
      thermal_torque_(thermal_limit(limits, torque_limit_Nm_, period_s)) {
  // Zero at the start and after each stop: a force always ramps up.
  ramp_.set(0.0);
}

LimitedForce Gate::limit(const GateInput& input) RT_SAFE {
  const double periods = 1.0 + input.skipped_periods;  // since the last write
  LimitedForce limited{.wrench = input.wanted};
  book_last_write(input, periods);
  // Order as in gate.h; no stage breaks the limit of an earlier one (README.md).
  check_finite(input, limited);
  ramp_down_missed_samples(input, limited);
  check_energy(input.armed, limited);
  if (!check_armed(input.armed, limited)) return without_force(limited);
  ramp_down_outside(input.tool, periods, limited);
  const Permitted permitted = permitted_now();
  keep_passive(permitted, limited);
  limit_magnitudes(permitted.thermal, limited);
  limit_slew(permitted.all, periods, limited);
  limit_power(input.tool, permitted.all, periods, limited);
  ramp_up(limited);
  check_power(input.tool, limited);
  if (latches(limited.fault)) return without_force(limited);
  written_ = limited.wrench;
  return limited;
}

void Gate::note(Stage stage, Fault reason, LimitedForce& limited) RT_SAFE {
  ++counter_[static_cast<std::size_t>(stage)];
  if (latches(reason))
    latch_first(reason, limited);
  else
    limited.acting = reason;
}

// Adds the last written force to the energy tank and to the thermal model: it acted until now.
void Gate::book_last_write(const GateInput& input, double periods) RT_SAFE {
  tank_.observe(input.tool, input.fresh && is_finite(input.tool), periods, written_);
  thermal_force_.add(written_.force_N, periods);
  thermal_torque_.add(written_.torque_Nm, periods);
}

void Gate::check_finite(const GateInput& input, LimitedForce& limited) RT_SAFE {
  if (!is_finite(input.tool)) note(Stage::kFinite, Fault::kSampleNotFinite, limited);
  if (is_finite(input.wanted)) return;
  note(Stage::kFinite, Fault::kForceNotFinite, limited);
  limited.wrench = {};
}

// Skipped periods count as missed samples, unless this tick has a fresh sample.
void Gate::ramp_down_missed_samples(const GateInput& input, LimitedForce& limited) RT_SAFE {
  // Ramps down by the samples missed since the last tick, without the first of a row.
  const std::int64_t held = std::max<std::int64_t>(missed_, 1);  // at the first the force is held
  const bool missing = !input.fresh && input.armed;  // before arming a device may start slowly
  missed_ = missing ? missed_ + 1 + input.skipped_periods : 0;
  const double level = fresh_.step(missed_ < 2, period_s_, static_cast<double>(missed_ - held));
  if (missed_ > 0 || level < 1.0)
    note(Stage::kFresh, missed_ == 1 ? Fault::kSampleHeld : Fault::kSampleStale, limited);
  if (missed_ >= kLostAfter) latch_first(Fault::kDeviceLost, limited);
  limited.wrench = level * limited.wrench;
}

void Gate::check_energy(bool armed, LimitedForce& limited) RT_SAFE {
  if (armed && tank_.is_overdrawn()) note(Stage::kPassivity, Fault::kEnergyOverdrawn, limited);
}

bool Gate::check_armed(bool armed, LimitedForce& limited) RT_SAFE {
  // No force on the hand: full budget, and motion before arming does not count.
  if (!armed) tank_.refill();
  if (armed && !latches(limited.fault)) return true;
  note(Stage::kArmed, Fault::kNotArmed, limited);
  return false;
}

void Gate::ramp_down_outside(const model::Tool& tool, double periods,
                             LimitedForce& limited) RT_SAFE {
  const double inside = workspace_.step(is_inside(limits_, tool.position_m), period_s_, periods);
  const double slow = speed_.step(is_slow(limits_, tool), period_s_, periods);
  if (slow < 1.0) note(Stage::kWorkspace, Fault::kTooFast, limited);
  // If both act, the workspace is reported.
  if (inside < 1.0) note(Stage::kWorkspace, Fault::kOutsideWorkspace, limited);
  limited.wrench = inside * slow * limited.wrench;
}

Gate::Permitted Gate::permitted_now() const RT_SAFE {
  const double passive_N = tank_.allowed_N(), passive_Nm = lever_m_ * passive_N;
  const double thermal_N = thermal_force_.allowed(), thermal_Nm = thermal_torque_.allowed();
  Magnitude all{.force_N = std::fmin(thermal_N, passive_N),
                .torque_Nm = std::fmin(thermal_Nm, passive_Nm)};
  if (const double fresh = fresh_.level(); fresh < 1.0) {  // the limit ramps down, too
    all.force_N = std::fmin(all.force_N, fresh * force_limit_N_);
    all.torque_Nm = std::fmin(all.torque_Nm, fresh * torque_limit_Nm_);
  }
  return {.energy = {passive_N, passive_Nm}, .thermal = {thermal_N, thermal_Nm}, .all = all};
}

void Gate::keep_passive(const Permitted& permitted, LimitedForce& limited) RT_SAFE {
  const Magnitude &energy = permitted.energy, &thermal = permitted.thermal;
  Wrench& w = limited.wrench;
  // The smaller limit acts and is reported: energy here, motor temperature in the next stage.
  const bool damped = tank_.damp(w);
  const bool braked =
      energy.force_N < thermal.force_N && limit_magnitude(w.force_N, energy.force_N);
  const bool turn_braked =
      energy.torque_Nm < thermal.torque_Nm && limit_magnitude(w.torque_Nm, energy.torque_Nm);
  if (damped || braked || turn_braked) note(Stage::kPassivity, Fault::kEnergyLimited, limited);
}

void Gate::limit_magnitudes(const Magnitude& thermal, LimitedForce& limited) RT_SAFE {
  if (limit_magnitude(limited.wrench.force_N, thermal.force_N))
    note(Stage::kMagnitude,
         thermal.force_N < force_limit_N_ ? Fault::kContinuousLimited : Fault::kForceLimited,
         limited);
  if (limit_magnitude(limited.wrench.torque_Nm, thermal.torque_Nm))
    note(Stage::kMagnitude,
         thermal.torque_Nm < torque_limit_Nm_ ? Fault::kContinuousLimited : Fault::kTorqueLimited,
         limited);
}

void Gate::limit_slew(const Magnitude& most, double periods, LimitedForce& limited) RT_SAFE {
  if (step_towards(limited.wrench, periods, most)) note(Stage::kSlew, Fault::kSlewLimited, limited);
}

// Removing the force along the motion can turn the force: the slew limit is applied again.
void Gate::limit_power(const model::Tool& tool, const Magnitude& most, double periods,
                       LimitedForce& limited) RT_SAFE {
  Wrench& w = limited.wrench;
  if (limit_surplus(w, tool.velocity_mps, tool.angular_velocity_radps,
                    kPowerAim_ratio * limits_.power_W)) {
    note(Stage::kPower, Fault::kPowerLimited, limited);
    step_towards(w, periods, most);
  }
  // Reference for the slew of the next tick. The change by the ramp is not part of it:
  // slew_beside_ramp_N leaves room for that.
  before_ramp_ = w;
}

bool Gate::step_towards(Wrench& w, double periods, const Magnitude& most) const RT_SAFE {
  const bool slow = approach(w.force_N, before_ramp_.force_N, force_step_N_,
                             periods * force_step_N_, most.force_N);
  return approach(w.torque_Nm, before_ramp_.torque_Nm, torque_step_Nm_, periods * torque_step_Nm_,
                  most.torque_Nm) ||
         slow;
}

void Gate::ramp_up(LimitedForce& limited) RT_SAFE {
  const double ramp = ramp_.step(true, period_s_);
  if (ramp < 1.0) note(Stage::kRamp, Fault::kRampingUp, limited);
  limited.wrench = ramp * limited.wrench;
}

// Checks the force after the ramp, which would be written. NaN latches.
void Gate::check_power(const model::Tool& tool, LimitedForce& limited) RT_SAFE {
  if (!(power_W(limited.wrench, tool) <= limits_.power_W))
    note(Stage::kPower, Fault::kPowerExceeded, limited);
}

// Zero force now; later forces ramp up from zero.
LimitedForce Gate::without_force(LimitedForce limited) RT_SAFE {
  before_ramp_ = {};
  ramp_.set(0.0);
  written_ = {};
  limited.wrench = {};
  return limited;
}

}  // namespace tact::firmware::gate
