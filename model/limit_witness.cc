// SPDX-License-Identifier: Apache-2.0
#include "model/limit_witness.h"

#include <algorithm>
#include <cmath>

namespace tact::model {
namespace {

constexpr double kHair = 1.0 + 1e-12;  // for the rounding of a difference or a product
constexpr double kRounding_J = 1e-8;   // for the sum of all energies since arming
constexpr double kRampDown_s = 0.010;  // of the force, from the second missed sample on

/// Small turns: twice the vector part of now * conjugate(before). Written out, as the operators of
/// Quat are the gate's, too.
Vec3 turn_rad(const Quat& before, const Quat& now) {
  const Vec3 a{before.x, before.y, before.z}, b{now.x, now.y, now.z};
  const double sign = now.w * before.w + dot(a, b) < 0.0 ? -2.0 : 2.0;
  return {sign * (before.w * b.x - now.w * a.x - b.y * a.z + b.z * a.y),
          sign * (before.w * b.y - now.w * a.y - b.z * a.x + b.x * a.z),
          sign * (before.w * b.z - now.w * a.z - b.x * a.y + b.y * a.x)};
}

void raise(double& most, double value) { most = std::max(most, value); }

}  // namespace

double given_power_W(const Wrench& w, const Tool& tool) {
  return dot(w.force_N, tool.velocity_mps) + dot(w.torque_Nm, tool.angular_velocity_radps);
}

LimitWitness::LimitWitness(const Limits& limits, double period_s)
    : limits_(limits),
      period_s_(period_s),
      lever_m_(limits.force_N > 0.0 ? limits.torque_Nm / limits.force_N : 0.0),
      continuous_N_(std::min(limits.continuous_force_N, limits.force_N)),
      step_N_(limits.slew_N_per_s * period_s) {}

const char* LimitWitness::check(const WrittenTick& tick) {
  if (!was_armed_) disarm();
  was_armed_ = tick.armed;
  const std::uint64_t passed = 1ull + tick.skipped_periods;  // since the write before
  const auto periods = static_cast<double>(passed);
  const bool stopped = !tick.armed || tick.faulted;  // then it goes to zero at once
  missed_samples_ = tick.fresh || !tick.armed ? 0 : missed_samples_ + passed;
  periods_ += passed;
  held_periods_ += passed;
  is_paused_ = is_paused_ || tick.skipped_periods > 0;
  add_thermal(periods);
  add_energy(tick, periods);
  keep_worst(tick, periods, stopped);
  const char* broken = broken_peak(tick, stopped);
  if (broken == nullptr) broken = broken_step(tick, periods, stopped);
  if (broken == nullptr) broken = broken_thermal();
  if (broken == nullptr) broken = broken_energy(stopped);
  before_ = tick.written;
  return broken;
}

// The force of the write before was on the hand until now, through every period that was skipped.
// Without a sample the way is not known: the force is added up until one comes.
void LimitWitness::add_energy(const WrittenTick& tick, double periods) {
  held_.force_N += periods * before_.force_N;
  held_.torque_Nm += periods * before_.torque_Nm;
  if (!tick.fresh || !is_finite(tick.tool)) return;
  if (is_placed_) {
    const Vec3 moved_m = tick.tool.position_m - position_m_;
    const Vec3 turned_rad = turn_rad(orientation_, tick.tool.orientation);
    const auto held_periods = static_cast<double>(held_periods_);
    const double held_s = held_periods * period_s_;
    const double done_J =
        (dot(held_.force_N, moved_m) + dot(held_.torque_Nm, turned_rad)) / held_periods;
    given_energy_J_ += done_J;
    lately_J_ = std::max(lately_J_ + done_J - limits_.recovery_W * held_s, 0.0);
    is_permitted_ = is_permitted_ && !is_paused_ && norm(moved_m) <= limits_.speed_mps * held_s &&
                    norm(turned_rad) <= limits_.turn_radps * held_s;
  }
  is_placed_ = true;
  is_paused_ = false;
  position_m_ = tick.tool.position_m;
  orientation_ = tick.tool.orientation;
  held_ = {};
  held_periods_ = 0;
}

// First order, as a motor warms: dh/dt = (F^2 - h) / thermal_time_s.
void LimitWitness::add_thermal(double periods) {
  const double share = std::min(periods * period_s_ / limits_.thermal_time_s, 1.0);
  mean_square_N2_ += share * (dot(before_.force_N, before_.force_N) - mean_square_N2_);
  torque_mean_square_N2m2_ +=
      share * (dot(before_.torque_Nm, before_.torque_Nm) - torque_mean_square_N2m2_);
  is_overheated_ = is_overheated_ || is_paused_;
  longest_s_ = is_overheated_ ? std::max(longest_s_, periods * period_s_) : 0.0;
}

double LimitWitness::max_given_energy_J() const {
  return limits_.energy_J + limits_.recovery_W * static_cast<double>(periods_) * period_s_;
}

void LimitWitness::keep_worst(const WrittenTick& tick, double periods, bool stopped) {
  const Wrench& w = tick.written;
  raise(worst_.force_N, norm(w.force_N));
  raise(worst_.torque_Nm, norm(w.torque_Nm));
  raise(worst_.grip_N, std::abs(tick.written_grip_N));
  if (!stopped) {
    raise(worst_.step_N, norm(w.force_N - before_.force_N) / periods);
    raise(worst_.step_Nm, norm(w.torque_Nm - before_.torque_Nm) / periods);
  }
  if (is_finite(tick.tool)) raise(worst_.power_W, given_power_W(w, tick.tool));
  raise(worst_.rms_N, std::sqrt(mean_square_N2_));
  raise(worst_.rms_Nm, std::sqrt(torque_mean_square_N2m2_));
  raise(worst_.given_energy_J, given_energy_J_);
  raise(worst_.overdrawn_J, given_energy_J_ - max_given_energy_J() * kRounding_ratio);
}

const char* LimitWitness::broken_peak(const WrittenTick& tick, bool stopped) const {
  const Wrench& w = tick.written;
  const double grip_N = tick.written_grip_N;
  if (!is_finite(w) || !std::isfinite(grip_N)) return "what is written is finite";
  if (stopped && (w != Wrench{} || grip_N != 0.0)) return "zero unless armed and without a fault";
  if (norm(w.force_N) > limits_.force_N) return "|F| <= force_N";
  if (norm(w.torque_Nm) > limits_.torque_Nm) return "|T| <= torque_Nm";
  if (std::abs(grip_N) > limits_.grip_force_N * kRounding_ratio) return "grip <= grip_force_N";
  if (!stopped && !(given_power_W(w, tick.tool) <= limits_.power_W))
    return "F . v + T . w <= power_W";
  constexpr double kNothing = kRounding_ratio - 1.0;
  const bool zero = norm(w.force_N) <= kNothing * limits_.force_N &&
                    norm(w.torque_Nm) <= kNothing * limits_.torque_Nm;
  if (missed_samples_ > 0 && static_cast<double>(missed_samples_ - 1) * period_s_ >= kRampDown_s &&
      !zero)
    return "zero within 10 ms of the second missed sample";
  return nullptr;
}

const char* LimitWitness::broken_step(const WrittenTick& tick, double periods, bool stopped) const {
  const Wrench& w = tick.written;
  const double step_N = step_N_ * kHair, step_Nm = step_N * lever_m_;
  if (!stopped && norm(w.force_N - before_.force_N) > periods * step_N)
    return "|dF| <= slew_N_per_s dt";
  if (!stopped && norm(w.torque_Nm - before_.torque_Nm) > periods * step_Nm)
    return "|dT| <= slew_N_per_s dt torque_Nm / force_N";
  if (norm(w.force_N) - norm(before_.force_N) > step_N ||
      norm(w.torque_Nm) - norm(before_.torque_Nm) > step_Nm)
    return "a late force grows by one period's slew";
  return nullptr;
}

const char* LimitWitness::broken_thermal() const {
  const double most_N2 = continuous_N_ * continuous_N_ * kRounding_ratio;
  const double lever2_m2 = lever_m_ * lever_m_;
  if (!is_overheated_ && mean_square_N2_ > most_N2) return "RMS <= continuous_force_N";
  if (!is_overheated_ && torque_mean_square_N2m2_ > lever2_m2 * most_N2)
    return "RMS of T <= continuous_force_N torque_Nm / force_N";
  // The third exception of firmware/gate/README.md; until the force has come down at the slew
  // another 10 ms pass.
  const double more = (2.0 * longest_s_ + 0.010) / limits_.thermal_time_s;
  const double late_N2 = most_N2 + more * limits_.force_N * limits_.force_N * kRounding_ratio;
  if (mean_square_N2_ > late_N2 || torque_mean_square_N2m2_ > lever2_m2 * late_N2)
    return "RMS^2 <= continuous^2 + force^2 (2 times the longest wait + 10 ms) / thermal_time_s";
  return nullptr;
}

const char* LimitWitness::broken_energy(bool stopped) const {
  const bool overdrawn = !(given_energy_J_ <= max_given_energy_J() + kRounding_J);
  if (!stopped && overdrawn) return "energy given: beyond the budget it stops in the same tick";
  if (is_permitted_ && overdrawn) return "energy given <= energy_J + recovery_W t";
  if (!stopped && lately_J_ > 2.0 * limits_.energy_J + kRounding_J)
    return "energy given in any t <= 2 energy_J + recovery_W t";
  return nullptr;
}

// What a tick without arming leaves behind.
void LimitWitness::disarm() {
  given_energy_J_ = lately_J_ = 0.0;
  periods_ = held_periods_ = 0;
  held_ = {};
  is_placed_ = false;
  is_permitted_ = true;
  const double most_N2 = continuous_N_ * continuous_N_;
  is_overheated_ = is_overheated_ && (mean_square_N2_ > most_N2 ||
                                      torque_mean_square_N2m2_ > lever_m_ * lever_m_ * most_N2);
}

}  // namespace tact::model
