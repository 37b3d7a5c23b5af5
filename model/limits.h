// SPDX-License-Identifier: Apache-2.0
// limits.h - what a scene allows at the most: the settings of the gate (firmware/gate/).
#pragma once

#include <cmath>

namespace tact::model {

struct Limits {
  double force_N = 0.0;                  // vector magnitude
  double torque_Nm = 0.0;                // vector magnitude
  double slew_N_per_s = 0.0;             // largest change of the force vector
  double ramp_s = 0.0;                   // ramp-up after arming
  double workspace_radius_m = 0.0;       // cylinder about the W x axis
  double workspace_half_length_m = 0.0;  // along the W x axis
  double speed_mps = 1.5;                // of the tool
  double turn_radps = 10.0;              // of the tool
  double energy_J = 0.1;                 // given to the hand beyond what was taken from it
  double recovery_W = 1e-4;              // of that budget
  double continuous_force_N = 20.0;      // largest RMS of the force; torque in proportion
  double thermal_time_s = 10.0;          // of that RMS
  double power_W = 20.0;                 // given to the hand
  double grip_force_N = 4.0;             // on the fingers; all else in proportion to force_N
};

/// As they act where the PC allows this share of the force: 1 with hard real time.
constexpr Limits limits_in_use(Limits limits, double force_share) {
  limits.force_N *= force_share;
  limits.torque_Nm *= force_share;
  limits.continuous_force_N *= force_share;
  limits.grip_force_N *= force_share;
  return limits;
}

/// Without a sample the force ramps down to zero in this time (RT-15), and no slew may hold that
/// up.
inline constexpr double kStaleRampDown_s = 0.010;
/// So many samples in a row that are missing are a lost device.
inline constexpr int kLostAfterSamples = 20;

/// GT-6: |d(r F)| <= r |dF| + F dr <= s dt. The change of force in a period that the ramp,
/// dr = dt/tr, leaves for everything else: (s - Fm/tr) dt. A scene whose slew is too slow for its
/// ramp is refused (scene/scene_limits.cc); it would keep a tenth.
inline double slew_beside_ramp_N(const Limits& limits, double force_limit_N, double period_s) {
  const double step_N = limits.slew_N_per_s * period_s;
  const double ramp_step_N = force_limit_N * period_s / limits.ramp_s;
  return std::fmax(step_N - ramp_step_N, 0.1 * step_N);
}
inline double slew_beside_ramp_N_per_s(const Limits& limits) {
  return slew_beside_ramp_N(limits, limits.force_N, 1.0);
}

/// GT-2, GT-3: what a force gives at most, at this speed, while it falls at the slew:
/// u (F^2 / (2 s) + F dt).
inline double brake_energy_J(double speed_mps, double force_N, double slew_N_per_s,
                             double period_s) {
  return speed_mps * force_N * (0.5 * force_N / slew_N_per_s + period_s);
}

/// GT-4: kappa = 2 (Fp^2 / Fc^2 - 1), of forces or of torques.
inline double thermal_steepness(double peak, double continuous) {
  return continuous > 0.0 ? 2.0 * (peak * peak / (continuous * continuous) - 1.0) : 0.0;
}

}  // namespace tact::model
