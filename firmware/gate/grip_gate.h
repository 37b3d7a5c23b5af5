// SPDX-License-Identifier: Apache-2.0
// grip_gate.h - limits the force of a gripper's motor on the fingers: a Gate with one axis.
//
//     force      (f, 0, 0)    f: on the fingers, opening positive, N
//     position   (g, 0, 0)    g: gap between the fingers, m
//
// With k = grip_force_N / force_N, the limits of force, continuous force, slew, energy, recovery
// and power are k times those of the scene; times and speeds are the same. The relations that
// scene_limits.cc requires are linear in the scaled limits, so they and the proof of the gate hold.
#pragma once

#include <optional>

#include "firmware/gate/gate.h"

namespace tact::firmware::gate {

struct GripInput {
  double wanted_N = 0.0;
  double gap_m = 0.0, speed_mps = 0.0;
  bool fresh = false;
  bool armed = false;
  std::uint32_t skipped_periods = 0;
};

struct LimitedGrip {
  double force_N = 0.0;  // to the device
  Fault acting = Fault::kNone;
  Fault fault = Fault::kNone;
};

/// Limits for the fingers; force limits are zero if the scene has no grip force.
inline model::Limits grip_limits(const model::Limits& limits) {
  const double k = limits.force_N > 0.0 ? limits.grip_force_N / limits.force_N : 0.0;
  return {.force_N = k * limits.force_N,
          .torque_Nm = 0.0,
          .slew_N_per_s = k * limits.slew_N_per_s,
          .ramp_s = limits.ramp_s,
          .workspace_radius_m = 1.0,  // wider than any gap
          .workspace_half_length_m = 1.0,
          .speed_mps = limits.speed_mps,
          .turn_radps = limits.turn_radps,
          .energy_J = k * limits.energy_J,
          .recovery_W = k * limits.recovery_W,
          .continuous_force_N = k * limits.continuous_force_N,
          .thermal_time_s = limits.thermal_time_s,
          .power_W = k * limits.power_W,
          .grip_force_N = 0.0};
}

class GripGate {
 public:
  /// Nothing if the limits permit no force on the fingers.
  static std::optional<GripGate> make(const model::Limits& limits, double period_s,
                                      double force_share) {
    const model::Limits own = grip_limits(limits);
    if (!(own.force_N > 0.0)) return std::nullopt;
    return GripGate(own, period_s, force_share);
  }

  LimitedGrip limit(const GripInput& in) RT_SAFE {
    const LimitedForce limited = gate_.limit(
        {.wanted = {.force_N = {in.wanted_N, 0.0, 0.0}, .torque_Nm = {}},
         .tool = {.position_m = {in.gap_m, 0.0, 0.0}, .velocity_mps = {in.speed_mps, 0.0, 0.0}},
         .fresh = in.fresh,
         .armed = in.armed,
         .skipped_periods = in.skipped_periods});
    return {.force_N = limited.wrench.force_N.x, .acting = limited.acting, .fault = limited.fault};
  }

 private:
  GripGate(const model::Limits& limits, double period_s, double force_share)
      : gate_(limits, period_s, force_share) {}

  Gate gate_;
};

}  // namespace tact::firmware::gate
