// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_balance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tact::hal::falcon::falcon_balance_test {

using State = FalconBalanceRamp::State;

/// A weight on a support, moved through friction; words are 1000 per newton and more.
struct Weight {
  double weight_N = 2.0, friction_N = 0.3;
  double height_m = 0.0, speed_mps = 0.0, force_N = 0.0, largest_N = 0.0;

  State lift(FalconBalanceRamp& ramp, double longest_s = 60.0) {
    for (double t = 0.0; t < longest_s && !ramp.ended(); t += 0.001) {
      const int word = static_cast<int>(std::lround(1000.0 * force_N));
      force_N = ramp.step(height_m, std::abs(speed_mps), {word, -word, 2 * word}, 0.001);
      largest_N = std::max(largest_N, force_N);
      const double net_N = force_N - weight_N;
      const double moving_N = std::copysign(std::max(0.0, std::abs(net_N) - friction_N), net_N);
      speed_mps = moving_N / 20.0;  // creeps
      if (height_m <= 0.0 && speed_mps < 0.0) speed_mps = 0.0;
      height_m = std::max(0.0, height_m + 0.001 * speed_mps);
    }
    return ramp.state();
  }
};

TEST(FalconBalance, FrictionDropsOutOfTheMeanOfLiftingAndSinking) {
  Weight weight;
  FalconBalanceRamp ramp({});
  ASSERT_EQ(weight.lift(ramp), State::kBalanced);
  EXPECT_NEAR(ramp.words()[0], 2000.0, 100.0);
  EXPECT_NEAR(ramp.words()[1], -2000.0, 100.0);
  EXPECT_NEAR(ramp.words()[2], 4000.0, 200.0);
  EXPECT_GT(weight.largest_N, 2.3);  // it did lift
  EXPECT_LT(weight.largest_N, 3.0);
  EXPECT_EQ(weight.force_N, 0.0);  // and lets go
}

TEST(FalconBalance, LoadAboveTheForceLimitEndsWithZeroForce) {
  Weight weight{.weight_N = 9.0};
  FalconBalanceRamp ramp({});
  EXPECT_EQ(weight.lift(ramp), State::kTooHeavy);
  EXPECT_LE(weight.largest_N, 6.0);
  EXPECT_EQ(weight.force_N, 0.0);
  EXPECT_STRNE(ramp.advice(), "");
}

TEST(FalconBalance, FastMotionAndNoNumbersEndTheForceAtOnce) {
  for (const double speed_mps : {0.2, std::numeric_limits<double>::quiet_NaN()}) {
    FalconBalanceRamp ramp({});
    EXPECT_GT(ramp.step(0.0, 0.0, {}, 0.1), 0.0);
    EXPECT_EQ(ramp.step(0.0, speed_mps, {}, 0.1), 0.0);
    EXPECT_EQ(ramp.state(), State::kTooFast);
    EXPECT_EQ(ramp.step(0.0, 0.0, {}, 0.1), 0.0);  // for good
  }
}

TEST(FalconBalance, RampWithoutMotionEndsByItsTimeLimit) {
  FalconBalanceRamp ramp({.rate_N_per_s = 0.01});
  for (int i = 0; i < 41'000; ++i) ramp.step(0.0, 0.0, {}, 0.001);
  EXPECT_EQ(ramp.state(), State::kTooLong);
}

}  // namespace tact::hal::falcon::falcon_balance_test
