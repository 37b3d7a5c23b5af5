// SPDX-License-Identifier: Apache-2.0
#include "model/contact/blade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace tact::model::contact::blade_test {

// An upright edge from z = -1 to 1 that moves along x from 0 to 1.
constexpr BladeSweep kSweep{
    .from_a_m = {0, 0, -1}, .from_b_m = {0, 0, 1}, .to_a_m = {1, 0, -1}, .to_b_m = {1, 0, 1}};

TEST(Blade, CutsWhatItPassesThroughAndNothingElse) {
  EXPECT_TRUE(crosses(kSweep, {0.5, -1, 0}, {0.5, 1, 0}));
  EXPECT_TRUE(crosses(kSweep, {0.9, -1, 0.9}, {0.9, 1, 0.9}));
  EXPECT_TRUE(crosses(kSweep, {0.1, 1, -0.9}, {0.1, -1, -0.9})) << "from either side";
  EXPECT_FALSE(crosses(kSweep, {1.1, -1, 0}, {1.1, 1, 0})) << "beyond its way";
  EXPECT_FALSE(crosses(kSweep, {0.5, -1, 1.1}, {0.5, 1, 1.1})) << "above the edge";
  EXPECT_FALSE(crosses(kSweep, {0.5, 0.1, 0}, {0.5, 1, 0})) << "beside it";
  EXPECT_FALSE(crosses(kSweep, {0.2, 0, 0}, {0.8, 0, 0})) << "in its plane";
}

TEST(Blade, LetsNothingSlipBetweenItsTwoTrianglesOrTwoTicks) {
  for (int i = 0; i <= 100; ++i) {
    const double x = 0.01 * i;
    EXPECT_TRUE(crosses(kSweep, {x, -1, 2 * x - 1}, {x, 1, 2 * x - 1})) << "on the diagonal";
  }
  BladeSweep next = kSweep;
  next.from_a_m.x = next.from_b_m.x = 1.0;
  next.to_a_m.x = next.to_b_m.x = 2.0;
  EXPECT_TRUE(crosses(kSweep, {1, -1, 0}, {1, 1, 0}) || crosses(next, {1, -1, 0}, {1, 1, 0}));
}

TEST(Blade, StandingStillCutsNothing) {
  BladeSweep still = kSweep;
  still.to_a_m = still.from_a_m;
  still.to_b_m = still.from_b_m;
  EXPECT_FALSE(crosses(still, {0, -1, 0}, {0, 1, 0}));
  BladeSweep along = kSweep;  // in its own direction
  along.to_a_m = {0, 0, 0};
  along.to_b_m = {0, 0, 2};
  EXPECT_FALSE(crosses(along, {0, -1, 0.5}, {0, 1, 0.5}));
}

TEST(Blade, NonFinitePointsCrossNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    EXPECT_FALSE(crosses(kSweep, {0.5, bad, 0}, {0.5, 1, 0}));
    BladeSweep broken = kSweep;
    broken.to_a_m.y = bad;
    EXPECT_FALSE(crosses(broken, {0.5, -1, 0}, {0.5, 1, 0}));
  }
}

TEST(Blade, MissesNothingThatItCrosses) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> at(-2.0, 2.0);
  const auto random_point_m = [&] { return Vec3{at(random), at(random), at(random)}; };
  int crossed = 0, missed = 0;
  for (int i = 0; i < 100000; ++i) {
    const BladeSweep s{.from_a_m = random_point_m(),
                       .from_b_m = random_point_m(),
                       .to_a_m = random_point_m(),
                       .to_b_m = random_point_m()};
    const Vec3 p_m = random_point_m(), q_m = random_point_m();
    const bool beyond = misses(box_around(s), p_m, q_m);
    if (beyond) ASSERT_FALSE(crosses(s, p_m, q_m)) << i;
    crossed += crosses(s, p_m, q_m);
    missed += beyond;
  }
  EXPECT_GT(crossed, 1000);
  EXPECT_GT(missed, 10000) << "or it saves nothing";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(misses(box_around(kSweep), {nan, nan, nan}, {nan, nan, nan}));
}

TEST(Blade, MovesWithTheTool) {
  const Blade blade{.a_m = {0, 0, 0}, .b_m = {0, 0, 0.02}};
  const Tool from{.position_m = {1, 2, 3}};
  const Tool to{.position_m = {1, 2, 4},
                .orientation = quat_from_rotation_vector({1.5707963267948966, 0, 0})};
  const BladeSweep s = sweep(blade, from, to);
  EXPECT_EQ(s.from_a_m, (Vec3{1, 2, 3}));
  EXPECT_EQ(s.from_b_m, (Vec3{1, 2, 3.02}));
  EXPECT_EQ(s.to_a_m, (Vec3{1, 2, 4}));
  EXPECT_NEAR(norm(s.to_b_m - Vec3{1, 1.98, 4}), 0.0, 1e-15);  // z turned to -y
}

}  // namespace tact::model::contact::blade_test
