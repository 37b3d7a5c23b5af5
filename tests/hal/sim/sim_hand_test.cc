// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/sim_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/no_alloc.h"

namespace tact::hal::sim::sim_hand_test {

constexpr double kStep_s = 0.25e-3;

model::HandSettings script(bool repeat) {
  model::HandSettings hand;
  hand.mass_kg = 0.2;
  hand.stiffness_N_per_m = 300.0;
  hand.damping_Ns_per_m = 8.0;
  hand.repeat = repeat;
  hand.path = {{0.0, {0.05, 0.0, 0.0}, {}, 0.0}, {1.0, {-0.02, 0.01, 0.0}, {0.0, 0.1, 0.0}, 1.0}};
  return hand;
}
/// Steps the hand and returns the longest single step of its aim.
double run(SimHand& hand, double seconds) {
  double longest_m = 0.0;
  for (long steps = std::lround(seconds / kStep_s); steps > 0; --steps) {
    const Vec3 before = hand.position_W_m();
    hand.step(kStep_s);
    longest_m = std::max(longest_m, norm(hand.position_W_m() - before));
  }
  return longest_m;
}

TEST(SimHand, FollowsItsScript) {
  SimHand hand(script(false));
  EXPECT_EQ(hand.position_W_m(), (Vec3{0.05, 0.0, 0.0}));
  run(hand, 0.5);  // half of a minimum-jerk move is half of the way, at 15/8 of the mean speed
  EXPECT_NEAR(hand.position_W_m().x, 0.015, 1e-6);
  EXPECT_NEAR(hand.velocity_mps().x, -0.07 * 15.0 / 8.0, 1e-5);
  EXPECT_NEAR(hand.grip_ratio(), 0.5, 1e-5);
  EXPECT_NEAR(hand.rotation_rad().y, 0.05, 1e-6);
  run(hand, 2.0);
  EXPECT_EQ(hand.position_W_m(), (Vec3{-0.02, 0.01, 0.0}));
  EXPECT_EQ(hand.velocity_mps(), Vec3{});
}

TEST(SimHand, WalksToTheMouseAtHalfAMetrePerSecond) {
  SimHand hand(script(false));
  const Vec3 goal{-0.1, 0.1, 0.05};
  double longest_m = 0.0;
  for (int i = 0; i < 20; ++i) {  // 20 messages a second
    hand.steer({.position_m = goal, .rotation_rad = {0.0, 0.0, 0.3}, .grip_ratio = 0.7});
    longest_m = std::max(longest_m, run(hand, 0.05));
  }
  EXPECT_LE(longest_m, 0.5 * kStep_s * 1.0001);
  EXPECT_GE(longest_m, 0.4 * kStep_s);
  EXPECT_LT(norm(hand.position_W_m() - goal), 1e-3);
  EXPECT_NEAR(hand.grip_ratio(), 0.7, 1e-9);
  EXPECT_LT(norm(hand.rotation_rad() - Vec3{0.0, 0.0, 0.3}), 1e-9);
  EXPECT_TRUE(hand.is_steered());
}

TEST(SimHand, TheScriptWaitsForThePersonAndGoesOnWithoutAJump) {
  SimHand hand(script(false)), undisturbed(script(false));
  run(hand, 0.3);
  run(undisturbed, 0.3);
  hand.steer({.position_m = {0.1, -0.05, 0.1}, .grip_ratio = 1.0});
  EXPECT_LE(run(hand, 0.9), 0.5 * kStep_s * 1.0001);
  EXPECT_TRUE(hand.is_steered());
  EXPECT_LE(run(hand, 3.0), 0.5 * kStep_s * 1.0001);
  EXPECT_FALSE(hand.is_steered());
  run(hand, 2.0);
  run(undisturbed, 2.0);
  EXPECT_LT(norm(hand.position_W_m() - undisturbed.position_W_m()), 1e-12);
  EXPECT_DOUBLE_EQ(hand.grip_ratio(), undisturbed.grip_ratio());
}

TEST(SimHand, ARepeatedScriptThatJumpsIsJoinedByAWalk) {
  SimHand hand(script(true));  // ends 70 mm from where it begins
  EXPECT_LE(run(hand, 6.0), 0.5 * kStep_s * 1.0001);
  double most_x = -1.0;
  for (double t = 0.0; t < 4.0; t += kStep_s) {
    hand.step(kStep_s);
    most_x = std::max(most_x, hand.position_W_m().x);
  }
  EXPECT_GT(most_x, 0.049);  // it does come back
}

TEST(SimHand, NeverExceedsItsAcceleration) {
  SimHand hand(script(false));
  hand.steer({.position_m = {-0.1, 0.1, 0.1}});
  Vec3 last = hand.velocity_mps();
  for (double t = 0.0; t < 0.9; t += kStep_s) {
    if (t > 0.4) hand.steer({.position_m = {0.1, -0.1, 0.0}});
    hand.step(kStep_s);
    EXPECT_LE(norm(hand.velocity_mps() - last), 5.0 * kStep_s * 1.0001);
    last = hand.velocity_mps();
  }
}

TEST(SimHand, IgnoresNanAndNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SimHand hand(script(false));
  hand.steer({.position_m = {nan, 0.0, 0.0}});
  hand.steer({.position_m = {}, .rotation_rad = {0.0, nan, 0.0}});
  hand.steer({.position_m = {}, .grip_ratio = nan});
  hand.step(0.0);
  hand.step(nan);
  EXPECT_FALSE(hand.is_steered());
  EXPECT_EQ(hand.position_W_m(), (Vec3{0.05, 0.0, 0.0}));
}

TEST(SimHand, LeavesTheHeapAlone) {
  SimHand hand(script(true));
  tests::NoAlloc guard;
  hand.step(kStep_s);
  hand.steer({});
  hand.step(kStep_s);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::sim::sim_hand_test
