// SPDX-License-Identifier: Apache-2.0
#include "model/scene/scene_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/scene/scene_keys.h"

namespace tact::model::scene {
namespace {

void visit_keys(Keys& k, Limits& limits) {
  k.number("force_N", {0.0, 20.0}, "largest force on the hand", limits.force_N);
  k.number("torque_Nm", {0.0, 2.0}, "largest torque on the hand", limits.torque_Nm);
  k.number("slew_N_per_s", {1.0, 1e4}, "largest change of the force", limits.slew_N_per_s);
  k.number("ramp_s", {0.1, 10.0}, "ramp of the force after arming", limits.ramp_s);
  k.number("workspace_radius_m", {0.01, 0.5}, "of the cylinder about the x axis of W",
           limits.workspace_radius_m);
  k.number("workspace_half_length_m", {0.01, 0.5}, "of the cylinder, from the origin of W",
           limits.workspace_half_length_m);
  k.number("speed_mps", {0.05, 10.0}, "faster, the force ramps down to zero", limits.speed_mps,
           kOptional);
  k.number("turn_radps", {0.5, 100.0}, "turning faster, the force ramps down to zero",
           limits.turn_radps, kOptional);
  k.number("energy_J", {1e-3, 10.0}, "given to the hand since arming beyond what was taken",
           limits.energy_J, kOptional);
  k.number("recovery_W", {0.0, 1.0}, "of that budget; shaking that takes no more is not damped",
           limits.recovery_W, kOptional);
  k.number("continuous_force_N", {0.1, 20.0},
           "largest RMS of the force, at most force_N; torque in proportion",
           limits.continuous_force_N, kOptional);
  k.number("thermal_time_s", {0.1, 1000.0}, "time constant of that RMS", limits.thermal_time_s,
           kOptional);
  k.number("power_W", {0.1, 100.0}, "largest power on the hand; held to three quarters of it",
           limits.power_W, kOptional);
  k.number("grip_force_N", {0.0, 8.0},
           "on the fingers of a gripper; all else in proportion to force_N", limits.grip_force_N,
           kOptional);
}

/// Rounded up to what a person would write.
double rounded_up(double value) { return std::ceil(1e3 * value) * 1e-3; }

/// RT-15: the gate ramps the largest force down to zero in 10 ms; its slew must not prevent that.
void refuse_slow_slew(Keys& k, const Limits& limits) {
  // The gate keeps force_N / ramp_s of the slew for its ramp.
  const double least_N_per_s = limits.force_N / kStaleRampDown_s + limits.force_N / limits.ramp_s;
  if (limits.slew_N_per_s >= least_N_per_s) return;
  k.refuse({"slew_N_per_s", "force_N"},
           fmt::format("limits.slew_N_per_s = {} is too slow for force_N = {}: a lost device must "
                       "ramp down in 10 ms; allowed: {} or more",
                       limits.slew_N_per_s, limits.force_N, least_N_per_s));
}

// The energy that the largest force gives at the largest speed while it falls at the slew must be
// there before the force is (firmware/gate/energy_tank.h); else the scene's force is never reached.
void refuse_small_budget(Keys& k, double rate_Hz, const Limits& limits) {
  const double force_N = limits.force_N;
  if (!(force_N > 0.0 && rate_Hz > 0.0)) return;
  const double speed_mps = limits.speed_mps + limits.torque_Nm / force_N * limits.turn_radps;
  const double least_J =
      brake_energy_J(speed_mps, force_N, slew_beside_ramp_N_per_s(limits), 1.0 / rate_Hz);
  if (limits.energy_J >= least_J) return;
  k.refuse({"energy_J", "force_N", "speed_mps"},
           fmt::format("limits.energy_J = {} is too little to let go of force_N = {} at speed_mps "
                       "= {}; allowed: {:.3f} or more, or a lower speed_mps",
                       limits.energy_J, force_N, limits.speed_mps, rounded_up(least_J)));
}

void refuse_fast_thermal(Keys& k, double rate_Hz, const Limits& limits) {
  const double least_s = least_thermal_time_s(limits, rate_Hz);
  if (limits.thermal_time_s >= least_s) return;
  k.refuse({"thermal_time_s", "continuous_force_N"},
           fmt::format("limits.thermal_time_s = {} is too short to come from force_N = {} to "
                       "continuous_force_N = {} within the slew; allowed: {:.3f} or more",
                       limits.thermal_time_s, limits.force_N,
                       std::min(limits.continuous_force_N, limits.force_N), rounded_up(least_s)));
}

}  // namespace

void visit_limits(Keys& k, double rate_Hz, Limits& limits) {
  visit_keys(k, limits);
  refuse_slow_slew(k, limits);
  refuse_small_budget(k, rate_Hz, limits);
  refuse_fast_thermal(k, rate_Hz, limits);
}

// The allowed force must fall no faster than the slew, and not below what is continuous.
double least_thermal_time_s(const Limits& limits, double rate_Hz) {
  const double peak_N = limits.force_N;
  const double continuous_N = std::min(limits.continuous_force_N, peak_N);
  if (!(continuous_N > 0.0 && rate_Hz > 0.0)) return 0.0;
  // thermal_limit.h: (1 + kappa) T <= tau, and kappa Fp^2 / (2 Fc tau) <= slew.
  const double steepness = thermal_steepness(peak_N, continuous_N);
  return std::max((1.0 + steepness) / rate_Hz, steepness * 0.5 * peak_N * peak_N / continuous_N /
                                                   slew_beside_ramp_N_per_s(limits));
}

}  // namespace tact::model::scene
