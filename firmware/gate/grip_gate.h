// SPDX-License-Identifier: Apache-2.0
// grip_gate.h - the one way from the model to the motor of a gripper: the force on the fingers
// passes the stages of gate.h, along one line.
//
//     force      (f, 0, 0)    f: on the fingers, opening positive, N
//     position   (g, 0, 0)    g: gap between the fingers, m
//
// Its limits are those of the scene in the proportion k = grip_force_N / force_N: force, continuous
// force, slew, energy, recovery and power k times as large, times and speeds the same. The
// relations that a scene's limits are held to (scene_limits.cc) are linear in these, so they hold
// here, too, and so does what is proved of the gate.
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

/// Limits of the fingers; all zero without a force on them.
inline model::Limits grip_limits(const model::Limits& limits) {
  const double k = limits.force_N > 0.0 ? limits.grip_force_N / limits.force_N : 0.0;
  return {.force_N = k * limits.force_N,
          .torque_Nm = 0.0,
          .slew_N_per_s = k * limits.slew_N_per_s,
          .ramp_s = limits.ramp_s,
          .workspace_radius_m = 1.0,  // no hand is so wide
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
  /// Nothing where these limits let no force on the fingers.
  static std::optional<GripGate> make(const model::Limits& limits, double period_s,
                                      double force_share) {
    const model::Limits own = grip_limits(limits);
    if (!(own.force_N > 0.0)) return std::nullopt;
    return GripGate(own, period_s, force_share);
  }

  LimitedGrip limit(const GripInput& in) RT_SAFE {
    const LimitedForce verdict = gate_.limit(
        {.wanted = {.force_N = {in.wanted_N, 0.0, 0.0}, .torque_Nm = {}},
         .tool = {.position_m = {in.gap_m, 0.0, 0.0}, .velocity_mps = {in.speed_mps, 0.0, 0.0}},
         .fresh = in.fresh,
         .armed = in.armed,
         .skipped_periods = in.skipped_periods});
    return {.force_N = verdict.wrench.force_N.x, .acting = verdict.acting, .fault = verdict.fault};
  }

 private:
  GripGate(const model::Limits& limits, double period_s, double force_share)
      : gate_(limits, period_s, force_share) {}

  Gate gate_;
};

}  // namespace tact::firmware::gate
