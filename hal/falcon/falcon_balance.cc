// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_balance.h"

#include <algorithm>

namespace tact::hal::falcon {

double FalconBalanceRamp::step(double height_m, double speed_mps, const std::array<int, 3>& words,
                               double elapsed_s) RT_SAFE {
  if (ended()) return 0.0;
  elapsed_s_ += elapsed_s;
  // From the lowest place: the grip may sag before it lifts.
  lowest_m_ = started_ ? std::min(lowest_m_, height_m) : height_m;
  started_ = true;
  // Not a number falls to the safe side.
  if (!(speed_mps <= settings_.fastest_mps)) return end(State::kTooFast), 0.0;
  if (!(elapsed_s_ <= settings_.longest_s)) return end(State::kTooLong), 0.0;
  const double step_N = settings_.rate_N_per_s * elapsed_s;
  if (state_ == State::kLifting) {
    force_N_ += step_N;
    if (!(force_N_ <= settings_.largest_N)) return end(State::kTooHeavy), 0.0;
    if (height_m - lowest_m_ >= settings_.move_m) {
      state_ = State::kLowering;
      // Weight plus friction; when it sinks, weight less friction.
      lifted_ = words;
      highest_m_ = height_m;
    }
    return force_N_;
  }
  highest_m_ = std::max(highest_m_, height_m);
  force_N_ = std::max(0.0, force_N_ - step_N);
  if (highest_m_ - height_m >= settings_.move_m) {
    coupled_ = words;
    end(State::kBalanced);
  }
  return force_N_;
}

std::array<double, 3> FalconBalanceRamp::words() const RT_SAFE {
  std::array<double, 3> mean{};
  for (std::size_t i = 0; i < 3; ++i) mean[i] = 0.5 * (lifted_[i] + coupled_[i]);
  return mean;
}

const char* FalconBalanceRamp::advice() const RT_SAFE {
  switch (state_) {
    case State::kTooHeavy:
      return "it did not lift: is the grip free and the mass right? Take a lighter one";
    case State::kTooLong:
      return "it took too long: leave the grip alone, and remove any object in contact with it";
    case State::kTooFast:
      return "it moved too fast, so the force went: keep hands off, and mind the pose";
    default:
      return "";
  }
}

}  // namespace tact::hal::falcon
