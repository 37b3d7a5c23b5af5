// SPDX-License-Identifier: Apache-2.0
// gate_monitor.h - the gate of the controller between a tissue and a device, with a witness.
//
// For any output of a law or an unstable loop, the written force must keep its limits
// (model/limit_witness.h); a latched fault may cut to zero at once.
#pragma once

#include "firmware/gate/gate.h"
#include "model/limit_witness.h"
#include "tools/stability/loop/haptic_loop.h"

namespace tact::tools::stability {

/// The limits of the liver scene, but for the energy: where the loop loses stability is measured
/// without the stage that would keep it stable.
inline constexpr model::Limits kSceneLimits{.force_N = 8.0,
                                            .torque_Nm = 0.2,
                                            .slew_N_per_s = 1000.0,
                                            .ramp_s = 0.5,
                                            .workspace_radius_m = 0.18,
                                            .workspace_half_length_m = 0.15,
                                            .energy_J = 1e9};

inline constexpr const char* kOutOfBounds = "OUT OF BOUNDS";

class GateMonitor {
 public:
  explicit GateMonitor(double rate_Hz)
      : gate_(kSceneLimits, 1.0 / rate_Hz, 1.0),
        witness_(kSceneLimits, 1.0 / rate_Hz),
        ramp_ticks_(static_cast<int>(2.0 * kSceneLimits.ramp_s * rate_Hz)) {}

  /// Arms and waits until the gate is fully open under this force.
  void open(double wanted_N) {
    for (int i = 0; i < ramp_ticks_; ++i) step(wanted_N, true);
    witness_.forget_worst();
  }

  /// One tick: the force written for the one wanted.
  double step(double wanted_N, bool fresh) {
    firmware::gate::GateInput input{.wanted = {}, .tool = {}, .fresh = fresh, .armed = armed_};
    input.wanted.force_N.x = wanted_N;
    const firmware::gate::LimitedForce verdict = gate_.limit(input);
    const bool latched = verdict.fault != model::Fault::kNone;
    const char* broken = witness_.check(
        {.written = verdict.wrench, .fresh = fresh, .armed = armed_, .faulted = latched});
    kept_bounds_ = kept_bounds_ && broken == nullptr;
    armed_ = armed_ && !latched;  // as the supervisor does
    return written_N_ = verdict.wrench.force_N.x;
  }

  /// What became of a run beyond its limit of stability: a word of the column beyond_the_line.
  const char* beyond_the_line() const {
    if (!kept_bounds()) return kOutOfBounds;
    if (is_latched()) return "20 lost in a row: the gate lets go and latches";
    return is_fought() ? "fights the limits of the gate" : "stays below the limits of the gate";
  }
  bool is_latched() const { return !armed_; }
  double written_N() const { return written_N_; }
  double max_force_N() const { return witness_.worst().force_N; }
  double max_step_N() const { return witness_.worst().step_N; }
  /// It was asked for more than it lets through.
  bool is_fought() const {
    constexpr double kNearLimit_ratio = 0.9;
    return max_force_N() > kNearLimit_ratio * kSceneLimits.force_N ||
           max_step_N() > kNearLimit_ratio * witness_.force_step_N();
  }
  bool kept_bounds() const { return kept_bounds_; }

 private:
  firmware::gate::Gate gate_;
  model::LimitWitness witness_;
  int ramp_ticks_;
  bool armed_ = true, kept_bounds_ = true;
  double written_N_ = 0.0;
};

/// A wall of this stiffness, pressed with 2 N, every force through the gate.
inline LoopRun run_gated_wall(LoopCase loop, double stiffness_N_per_m, GateMonitor& gate) {
  // A quarter of the gate's limit: the swing has room before it is clipped.
  constexpr double kPush_N = 2.0;
  loop.balance_m = kPush_N / stiffness_N_per_m;
  gate.open(kPush_N);
  return run_loop(
      loop, [&](double depth_m) { return stiffness_N_per_m * depth_m; },
      [&](double wanted_N, bool fresh) { return gate.step(wanted_N, fresh); });
}

}  // namespace tact::tools::stability
