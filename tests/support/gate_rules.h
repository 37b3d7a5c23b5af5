// SPDX-License-Identifier: Apache-2.0
// gate_rules.h - what must hold of every tick of the gate, for any input: the limits by their
// witness (model/limit_witness.h), and what latches. Property tests and the fuzzer feed it.
//
// The tool turns about x alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/gate/gate.h"
#include "model/limit_witness.h"
#include "tests/support/gate_settings.h"

namespace tact::tests {

using firmware::gate::GateInput;
using firmware::gate::LimitedForce;
using model::Vec3;

inline constexpr std::uint64_t kLost = 20;  // missed samples in a row

struct RuleTick {
  GateInput gate;
  double angle_rad = 0.0;  // of the tool about x
};

class GateRules {
 public:
  explicit GateRules(const GateSetting& setting = {})
      : gate_(setting.limits, setting.period_s(), setting.force_share),
        witness_(as_they_act(setting), setting.period_s()) {}

  /// One tick. The rule that it broke, or null.
  const char* check(RuleTick tick) {
    GateInput& input = tick.gate;
    const double angle_rad = std::remainder(tick.angle_rad, 4.0 * std::numbers::pi);
    input.tool.orientation = {std::cos(0.5 * angle_rad), std::sin(0.5 * angle_rad), 0, 0};
    limited_ = gate_.limit(input);
    const char* broken = witness_.check({.written = limited_.wrench,
                                         .tool = input.tool,
                                         .fresh = input.fresh,
                                         .armed = input.armed,
                                         .faulted = latches(limited_.fault),
                                         .skipped_periods = input.skipped_periods});
    if (witness_.is_motion_permitted())
      max_given_energy_J_ = std::max(max_given_energy_J_, witness_.total_given_energy_J());
    return broken != nullptr ? broken : broken_latch_rule(input);
  }

  const LimitedForce& limited() const { return limited_; }
  const firmware::gate::Gate& gate() const { return gate_; }
  /// Where no step was too long for its time.
  double max_given_energy_J() const { return max_given_energy_J_; }
  double most_thermal_ratio() const { return witness_.rms_ratio(); }
  double most_torque_thermal_ratio() const { return witness_.rms_torque_ratio(); }

 private:
  /// Written out: limits_in_use() is the gate's, too.
  static model::Limits as_they_act(const GateSetting& setting) {
    model::Limits limits = setting.limits;
    limits.force_N = setting.limits.force_N * setting.force_share;
    limits.torque_Nm = setting.limits.torque_Nm * setting.force_share;
    limits.continuous_force_N = setting.limits.continuous_force_N * setting.force_share;
    limits.grip_force_N = setting.limits.grip_force_N * setting.force_share;
    return limits;
  }
  const char* broken_latch_rule(const GateInput& input) const {
    const model::Fault fault = limited_.fault;
    if (!is_finite(input.wanted) && fault == model::Fault::kNone) return "NaN and infinity latch";
    if (!is_finite(input.tool) && fault == model::Fault::kNone) return "a sample of NaN latches";
    // Samples are counted in periods: what was skipped before this tick is missing too.
    const std::uint64_t missed = witness_.missed_samples();
    if (missed >= kLost && !latches(fault)) return "20 missed samples in a row latch";
    if (missed < kLost && fault == model::Fault::kDeviceLost)
      return "fewer than 20 missed samples lose nothing";
    if (fault == model::Fault::kEnergyOverdrawn && witness_.is_motion_permitted())
      return "without a step too long nothing is overdrawn";
    return nullptr;
  }

  firmware::gate::Gate gate_;
  model::LimitWitness witness_;
  LimitedForce limited_;
  double max_given_energy_J_ = 0.0;
};

}  // namespace tact::tests
