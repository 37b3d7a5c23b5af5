// SPDX-License-Identifier: Apache-2.0
// falcon_balance.h - the force that just balances a weight: up until it lifts, down until it sinks.
//
//     force +r dt while it rests, -r dt once it has lifted by 2 mm, until it has gone down by 2 mm
//
// Friction makes it lift late and sink late by the same force, so the mean of the two is the
// balance. It ends without a result at the largest force, after the longest time, and as soon as
// anything moves fast. SI units; W z is up.
#pragma once

#include <array>

#include "model/rt.h"
#include "model/types.h"

namespace tact::hal::falcon {

struct FalconBalanceSettings {
  double rate_N_per_s = 0.5;
  double largest_N = 6.0;
  double longest_s = 40.0;
  double move_m = 0.002;
  double fastest_mps = 0.15;  // beyond it the force goes
};

class FalconBalanceRamp {
 public:
  enum class State { kLifting, kLowering, kBalanced, kTooHeavy, kTooLong, kTooFast };

  explicit FalconBalanceRamp(const FalconBalanceSettings& settings) : settings_(settings) {}

  /// The force for now, N; zero when it has ended. `words`: what the last force was.
  double step(double height_m, double speed_mps, const std::array<int, 3>& words,
              double elapsed_s) RT_SAFE;
  State state() const RT_SAFE { return state_; }
  bool ended() const RT_SAFE { return state_ != State::kLifting && state_ != State::kLowering; }
  /// Means of lifting and sinking, of a balanced weight.
  std::array<double, 3> words() const RT_SAFE;
  /// What an end without a result means, and the remedy; "" otherwise.
  const char* advice() const RT_SAFE;

 private:
  void end(State state) RT_SAFE { state_ = state, force_N_ = 0.0; }

  FalconBalanceSettings settings_;
  State state_ = State::kLifting;
  bool started_ = false;
  double lowest_m_ = 0.0, highest_m_ = 0.0, force_N_ = 0.0, elapsed_s_ = 0.0;
  std::array<int, 3> lifted_{}, coupled_{};
};

}  // namespace tact::hal::falcon
