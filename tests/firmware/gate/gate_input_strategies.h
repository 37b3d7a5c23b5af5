// SPDX-License-Identifier: Apache-2.0
// gate_input_strategies.h - random sequences of inputs for the gate. Every sequence has a temper,
// and each is there to break one promise.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "tests/support/gate_rules.h"

namespace tact::tests {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kMax = std::numeric_limits<double>::max();
inline constexpr double kMin = std::numeric_limits<double>::min();
inline constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
inline constexpr std::array kOdd{0.0,
                                 -0.0,
                                 kDenormal,
                                 -kDenormal,
                                 kMin,
                                 -kMin,
                                 1e-3,
                                 -1e-3,
                                 7.9999,
                                 8.0,
                                 -8.0,
                                 1e6,
                                 1e300,
                                 -1e300,
                                 kMax,
                                 -kMax,
                                 kInfinity,
                                 -kInfinity,
                                 std::numeric_limits<double>::quiet_NaN()};

/// What a sequence of inputs is after.
enum class InputStrategy {
  kAny,     // anything, odd values included
  kFollow,  // the tool flees with the force, as fast as permitted, samples missing: energy
  kRattle,  // to and fro as fast as permitted, pushed at every return: energy, against the guess
  kPush,    // the largest force, held: heat
  kThrow,   // the tool's velocity jumps: power
  kJump,    // steps longer than permitted, positions again and reversed: overdraws
  kLose,    // samples are missing, one by one or in a row, periods are skipped
};
inline constexpr int kInputStrategies = 7;

/// Vigna's SplitMix64: a million sequences, and none waits for its seed.
class Chances {
 public:
  using result_type = std::uint64_t;
  explicit Chances(std::uint64_t seed) : state_(seed) {}
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

class Sequence {
 public:
  Sequence(std::uint64_t seed, InputStrategy strategy, const GateSetting& setting = {})
      : random_(seed),
        strategy_(strategy),
        is_lossy_(seed % 2 == 1),
        period_s_(setting.period_s()),
        step_m_(setting.limits.speed_mps * period_s_),
        turn_rad_(setting.limits.turn_radps * period_s_) {}

  RuleTick next(const model::Wrench& written) {
    ++tick_;
    if (chance(0.002)) armed_ = !armed_;
    if (chance(0.01)) wanted_ = {ball(chance(0.5) ? 100.0 : 6.0), ball(chance(0.5) ? 1.0 : 0.1)};
    move(written);
    RuleTick out{.gate = {.wanted = wanted_, .tool = {}, .fresh = true, .armed = armed_},
                 .angle_rad = angle_rad_};
    out.gate.tool.position_m = position_m_;
    out.gate.tool.velocity_mps = velocity_mps_;
    out.gate.tool.angular_velocity_radps = turning_radps_;
    if (strategy_ == InputStrategy::kFollow && is_lossy_) out.gate.fresh = !chance(0.5);
    if (strategy_ == InputStrategy::kLose || strategy_ == InputStrategy::kAny) {
      out.gate.fresh = !chance(0.3);
      if (chance(0.02)) out.gate.skipped_periods = static_cast<std::uint32_t>(random_() % 40);
    }
    if (strategy_ == InputStrategy::kLose && is_lossy_) fall_silent(out.gate);
    if (strategy_ == InputStrategy::kAny && chance(0.05)) spoil(out);
    return out;
  }

 private:
  bool chance(double p) { return unit_(random_) < p; }
  double within(double most) { return most * (2.0 * unit_(random_) - 1.0); }
  Vec3 ball(double most) { return {within(most), within(most), within(most)}; }

  void move(const model::Wrench& written) {
    Vec3 step_m = ball(0.5 * step_m_);
    double turn_rad = within(turn_rad_);
    if (strategy_ == InputStrategy::kFollow) {
      step_m = step_m_ * 0.999999 * normalized(written.force_N);
      turn_rad = written.torque_Nm.x > 0.0 ? 0.999999 * turn_rad_ : -0.999999 * turn_rad_;
    } else if (strategy_ == InputStrategy::kRattle) {
      const double sign = tick_ / 2 % 2 == 0 ? 1.0 : -1.0;
      step_m = {sign * step_m_ * 0.999999, 0, 0};
      wanted_.force_N = {tick_ % 2 == 0 ? 50.0 * sign : -50.0 * sign, within(1.0), 0};
    } else if (strategy_ == InputStrategy::kPush) {
      step_m = {};
      wanted_ = {{50, 0, 0}, {0, 1, 0}};
    } else if (strategy_ == InputStrategy::kJump && chance(0.05)) {
      step_m = chance(0.5) ? ball(0.1) : -1.0 * (position_m_ + past_m_);
    }
    past_m_ = position_m_;
    position_m_ += step_m;
    if (!(norm(position_m_) < 0.1) && strategy_ != InputStrategy::kFollow) position_m_ = {};
    angle_rad_ += turn_rad;
    velocity_mps_ = (position_m_ - past_m_) / period_s_;
    turning_radps_ = {turn_rad / period_s_, 0, 0};
    if (strategy_ == InputStrategy::kThrow && chance(0.1))
      velocity_mps_ = ball(chance(0.5) ? 1.0 : 3.0);
    // not what this is about
    if (strategy_ == InputStrategy::kFollow || strategy_ == InputStrategy::kRattle) {
      velocity_mps_ = turning_radps_ = {};
      if (!(norm(position_m_) < 0.14)) armed_ = false, position_m_ = past_m_ = {};
    }
  }

  // No sample for up to 15 ticks, and every tick takes up to four periods.
  void fall_silent(GateInput& out) {
    if (silent_ticks_ == 0 && chance(0.01)) silent_ticks_ = 1 + static_cast<int>(random_() % 15);
    if (silent_ticks_ == 0) return;
    --silent_ticks_;
    out.fresh = false;
    out.skipped_periods = static_cast<std::uint32_t>(random_() % 4);
  }

  void spoil(RuleTick& out) {
    const std::array fields{&out.gate.wanted.force_N, &out.gate.wanted.torque_Nm,
                            &out.gate.tool.position_m, &out.gate.tool.velocity_mps,
                            &out.gate.tool.angular_velocity_radps};
    Vec3& field = *fields[random_() % fields.size()];
    const std::array numbers{&field.x, &field.y, &field.z, &out.angle_rad};
    *numbers[random_() % numbers.size()] = kOdd[random_() % kOdd.size()];
  }

  Chances random_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
  InputStrategy strategy_;
  bool is_lossy_;
  double period_s_, step_m_, turn_rad_;  // as far as it may move and turn in a period
  int tick_ = 0, silent_ticks_ = 0;
  bool armed_ = true;
  model::Wrench wanted_;
  Vec3 position_m_, past_m_, velocity_mps_, turning_radps_;
  double angle_rad_ = 0.0;
};

}  // namespace tact::tests
