// SPDX-License-Identifier: Apache-2.0
// gate_rules.h - what must hold of every tick of the gate, whatever went in: the list of gate.h,
// with its own accounts of energy and heat. Property tests and the fuzzer feed it.
//
// The tool turns about x alone, so that a rotation is an angle here and no quaternion.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/gate/gate.h"
#include "tests/support/gate_settings.h"

namespace tact::tests {

using firmware::gate::GateInput;
using firmware::gate::GateVerdict;
using model::Vec3;

inline constexpr double kFade_s = 0.010;  // of the force, from the second missed sample on
inline constexpr double kLost = 20.0;     // missed samples in a row

struct RuleTick {
  GateInput gate;
  double angle_rad = 0.0;  // of the tool about x
};

class GateRules {
 public:
  explicit GateRules(const GateSetting& setting = {})
      : limits_(setting.limits),
        period_s_(setting.period_s()),
        force_N_(setting.force_share * limits_.force_N),
        torque_Nm_(setting.force_share * limits_.torque_Nm),
        lever_m_(limits_.force_N > 0.0 ? limits_.torque_Nm / limits_.force_N : 0.0),
        continuous_N_(setting.force_share * std::min(limits_.continuous_force_N, limits_.force_N)),
        gate_(limits_, period_s_, setting.force_share) {}

  /// One tick. The rule that it broke, or null.
  const char* judge(RuleTick tick) {
    GateInput& input = tick.gate;
    tick.angle_rad = std::remainder(tick.angle_rad, 4.0 * std::numbers::pi);  // a whole turn of q
    input.tool.orientation = {std::cos(0.5 * tick.angle_rad), std::sin(0.5 * tick.angle_rad), 0, 0};
    const bool sound = is_finite(input.tool);
    account(tick, input.fresh && sound);
    verdict_ = gate_.judge(input);
    const bool stopped = !input.armed || latches(verdict_.fault);
    const char* broken = broken_rule(input, sound, stopped);
    before_ = verdict_.wrench;
    if (!input.armed) start_anew();
    return broken;
  }

  const GateVerdict& verdict() const { return verdict_; }
  const firmware::gate::Gate& gate() const { return gate_; }
  double given_J() const { return given_J_; }
  double most_given_J() const { return most_given_J_; }
  double most_heat_ratio() const { return most_heat_ratio_; }
  double most_torque_heat_ratio() const { return most_torque_heat_ratio_; }

 private:
  // Of the RMS to what is allowed for ever; 0 where nothing is allowed and nothing was written.
  double heat_ratio() const { return heat_ > 0.0 ? std::sqrt(heat_) / continuous_N_ : 0.0; }
  double torque_heat_ratio() const {
    return torque_heat_ > 0.0 ? std::sqrt(torque_heat_) / (continuous_N_ * lever_m_) : 0.0;
  }

  // The energy and the heat of what was written before this tick.
  void account(const RuleTick& tick, bool fresh) {
    const double periods = 1.0 + tick.gate.skipped_periods;
    const double share = std::min(periods * period_s_ / limits_.thermal_time_s, 1.0);
    heat_ += share * (dot(before_.force_N, before_.force_N) - heat_);
    torque_heat_ += share * (dot(before_.torque_Nm, before_.torque_Nm) - torque_heat_);
    is_paused_ = is_paused_ || tick.gate.skipped_periods > 0;
    is_overheated_ = is_overheated_ || is_paused_;
    longest_s_ = is_overheated_ ? std::max(longest_s_, periods * period_s_) : 0.0;
    time_s_ += periods * period_s_;
    held_s_ += periods * period_s_;
    impulse_Ns_ += periods * period_s_ * before_.force_N;
    twist_Nms_ += periods * period_s_ * before_.torque_Nm.x;
    if (!fresh) return;
    if (is_placed_) {
      const Vec3 step_m = tick.gate.tool.position_m - position_m_;
      const double turn = std::remainder(tick.angle_rad - angle_rad_, 2.0 * std::numbers::pi);
      const double turn_rad = 2.0 * std::sin(0.5 * turn);
      given_J_ += (dot(impulse_Ns_, step_m) + twist_Nms_ * turn_rad) / held_s_;
      is_permitted_ = is_permitted_ && !is_paused_ && norm(step_m) <= limits_.speed_mps * held_s_ &&
                      std::abs(turn_rad) <= limits_.turn_radps * held_s_;
    }
    is_placed_ = true;
    is_paused_ = false;
    position_m_ = tick.gate.tool.position_m;
    angle_rad_ = tick.angle_rad;
    impulse_Ns_ = {};
    twist_Nms_ = held_s_ = 0.0;
  }

  const char* broken_rule(const GateInput& input, bool sound, bool stopped) {
    constexpr double kRounding = 1e-9;
    const model::Wrench& w = verdict_.wrench;
    if (!is_finite(w)) return "the output is finite";
    if (!is_finite(input.wanted) && verdict_.fault == model::Fault::kNone)
      return "NaN and infinity latch";
    if (!sound && verdict_.fault == model::Fault::kNone) return "a sample of NaN latches";
    if (stopped && !(w == model::Wrench{})) return "zero unless armed and without a fault";
    if (norm(w.force_N) > force_N_) return "|F| <= force_N";
    if (norm(w.torque_Nm) > torque_Nm_) return "|T| <= torque_Nm";
    if (const char* broken = broken_loss_rule(input, stopped)) return broken;
    const double step_N = limits_.slew_N_per_s * period_s_;
    const double periods = 1.0 + input.skipped_periods;  // since the write before
    const double step_Nm = step_N * lever_m_;
    const double grown_N = norm(w.force_N) - norm(before_.force_N);
    const double grown_Nm = norm(w.torque_Nm) - norm(before_.torque_Nm);
    if (!stopped && norm(w.force_N - before_.force_N) > periods * step_N + kRounding)
      return "|dF| <= slew_N_per_s dt";
    if (!stopped && norm(w.torque_Nm - before_.torque_Nm) > periods * step_Nm + kRounding)
      return "|dT| <= slew dt torque_Nm / force_N";
    if (grown_N > step_N + kRounding || grown_Nm > step_Nm + kRounding)
      return "a late force grows by one period's slew";
    const double power_W = dot(w.force_N, input.tool.velocity_mps) +
                           dot(w.torque_Nm, input.tool.angular_velocity_radps);
    if (!stopped && !(power_W <= limits_.power_W)) return "F . v + T . w <= power_W";
    most_heat_ratio_ = std::max(most_heat_ratio_, heat_ratio());
    most_torque_heat_ratio_ = std::max(most_torque_heat_ratio_, torque_heat_ratio());
    if (!is_overheated_ && heat_ratio() > 1.0 + kRounding) return "RMS <= continuous_force_N";
    if (!is_overheated_ && torque_heat_ratio() > 1.0 + kRounding)
      return "RMS of T <= continuous_force_N torque_Nm / force_N";
    // The third exception of firmware/gate/README.md; until the force has come down at the slew
    // another 10 ms pass.
    const double more = (2.0 * longest_s_ + 0.010) / limits_.thermal_time_s;
    const double bound = continuous_N_ * continuous_N_ + more * force_N_ * force_N_;
    if (heat_ > bound * (1.0 + kRounding) ||
        torque_heat_ > lever_m_ * lever_m_ * bound * (1.0 + kRounding))
      return "RMS^2 <= continuous^2 + force^2 (2 times the longest wait + 10 ms) / thermal_time_s";
    return broken_energy_rule(stopped);
  }

  // Samples are counted in periods: what was skipped before this tick is missing too.
  const char* broken_loss_rule(const GateInput& input, bool stopped) {
    constexpr double kRounding = 1e-9;
    missed_ = input.fresh || !input.armed ? 0.0 : missed_ + 1.0 + input.skipped_periods;
    const bool zero = norm(verdict_.wrench.force_N) <= kRounding * force_N_ &&
                      norm(verdict_.wrench.torque_Nm) <= kRounding * torque_Nm_;
    if ((missed_ - 1.0) * period_s_ >= kFade_s && !zero)
      return "zero within 10 ms of the second missed sample";
    if (missed_ >= kLost && !stopped) return "20 missed samples in a row latch";
    if (missed_ < kLost && verdict_.fault == model::Fault::kDeviceLost)
      return "fewer than 20 missed samples lose nothing";
    return nullptr;
  }

  const char* broken_energy_rule(bool stopped) {
    constexpr double kRounding_J = 1e-8;
    const double budget_J = limits_.energy_J + limits_.recovery_W * time_s_ + kRounding_J;
    const bool overdrawn = verdict_.fault == model::Fault::kEnergyOverdrawn;
    if (!stopped && !(given_J_ <= budget_J)) return "beyond the budget it stops in the same tick";
    if (is_permitted_ && !(given_J_ <= budget_J)) return "energy given <= energy_J + recovery_W t";
    if (overdrawn && is_permitted_) return "without a step too long nothing is overdrawn";
    if (is_permitted_) most_given_J_ = std::max(most_given_J_, given_J_);
    return nullptr;
  }

  void start_anew() {
    given_J_ = time_s_ = held_s_ = twist_Nms_ = 0.0;
    impulse_Ns_ = {};
    is_placed_ = false;
    is_permitted_ = true;
    is_overheated_ = is_overheated_ && (heat_ratio() > 1.0 || torque_heat_ratio() > 1.0);
  }

  model::Limits limits_;
  double period_s_;
  double force_N_, torque_Nm_, lever_m_, continuous_N_;  // of the share of the force
  firmware::gate::Gate gate_;
  GateVerdict verdict_;
  model::Wrench before_;
  double missed_ = 0.0;  // samples in a row, one a period
  double heat_ = 0.0, most_heat_ratio_ = 0.0;
  double torque_heat_ = 0.0, most_torque_heat_ratio_ = 0.0;
  double given_J_ = 0.0, most_given_J_ = 0.0;  // since it was armed; where no step was too long
  double time_s_ = 0.0, held_s_ = 0.0;         // since it was armed, since the last sample
  Vec3 impulse_Ns_;
  double twist_Nms_ = 0.0;
  Vec3 position_m_;
  double angle_rad_ = 0.0;
  bool is_placed_ = false;
  bool is_permitted_ = true;    // no step since it was armed was too long for its time
  bool is_paused_ = false;      // periods were skipped since the last sample
  bool is_overheated_ = false;  // by a force that was held for longer than the gate could know
  double longest_s_ = 0.0;      // that one was held meanwhile
};

}  // namespace tact::tests
