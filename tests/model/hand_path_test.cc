// SPDX-License-Identifier: Apache-2.0
// A simulated hand moves as people do: from rest to rest, without a jerk.
#include "model/hand_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "model/units.h"
#include "tests/support/no_alloc.h"

namespace tact::model::hand_path_test {

const std::vector<HandWaypoint> kPath{
    {.time_s = 0.0, .position_m = {0, 0, 60_mm}},
    {.time_s = 2.0, .position_m = {0, 20_mm, 0}, .rotation_rad = {0.2, 0, 0}, .grip_ratio = 1.0},
    {.time_s = 3.0, .position_m = {0, 20_mm, 0}, .grip_ratio = 1.0},
    {.time_s = 5.0, .position_m = {0, 0, 60_mm}},
};

double z_m(double time_s) { return hand_target(kPath, false, time_s).position_m.z; }
double speed_mps(double time_s, double h = 1e-6) {
  return (z_m(time_s + h) - z_m(time_s - h)) / (2 * h);
}

TEST(HandPath, PassesThroughEveryWaypoint) {
  for (const HandWaypoint& point : kPath) {
    const HandWaypoint at = hand_target(kPath, false, point.time_s);
    EXPECT_EQ(at.position_m, point.position_m) << point.time_s;
    EXPECT_EQ(at.rotation_rad, point.rotation_rad) << point.time_s;
    EXPECT_EQ(at.grip_ratio, point.grip_ratio) << point.time_s;
  }
}

TEST(HandPath, MatchesPenAndPaper) {
  // s = 1/4: 10/64 - 15/256 + 6/1024 = 106/1024; s = 1/2: 1/2
  EXPECT_NEAR(z_m(0.5), 60_mm * (1.0 - 106.0 / 1024.0), 1e-15);
  EXPECT_NEAR(z_m(1.0), 30_mm, 1e-15);
  EXPECT_NEAR(hand_target(kPath, false, 1.0).grip_ratio, 0.5, 1e-15);
  EXPECT_NEAR(hand_target(kPath, false, 1.0).rotation_rad.x, 0.1, 1e-15);
}

TEST(HandPath, ThePointThatShallGoStraightDoes) {
  const Vec3 tip_m{0, 0, -93_mm};
  const std::vector<HandWaypoint> tilt{
      {.time_s = 0.0, .position_m = {0, 0, 93_mm}},
      {.time_s = 1.0,
       .position_m = rotate(quat_from_rotation_vector({0.35, 0, 0}), -tip_m),
       .rotation_rad = {0.35, 0, 0},
       .straight_m = tip_m}};
  for (double t = 0.0; t <= 1.0; t += 0.0625) {
    const HandWaypoint at = hand_target(tilt, false, t);
    const Vec3 tip_W_m = at.position_m + rotate(quat_from_rotation_vector(at.rotation_rad), tip_m);
    EXPECT_LT(norm(tip_W_m), 1e-15) << t;
  }
}

TEST(HandPath, RestsAtEveryWaypoint) {
  for (const double time_s : {2.0, 3.0}) {
    EXPECT_NEAR(speed_mps(time_s), 0.0, 1e-9);
    const double h = 1e-4;  // second difference: the error is the jerk times h
    EXPECT_NEAR((z_m(time_s + h) - 2.0 * z_m(time_s) + z_m(time_s - h)) / (h * h), 0.0, 0.05);
  }
}

TEST(HandPath, IsFastestHalfWayAt15EighthsOfTheMeanSpeed) {
  const double mean_mps = -60_mm / 2.0;
  EXPECT_NEAR(speed_mps(1.0), 15.0 / 8.0 * mean_mps, 1e-7);
  for (double t = 0.01; t < 2.0; t += 0.01) {
    EXPECT_LE(speed_mps(t), 1e-9) << "never turns back";
    EXPECT_GE(speed_mps(t), 15.0 / 8.0 * mean_mps - 1e-7);
  }
}

TEST(HandPath, StaysOnTheLineBetweenTwoWaypoints) {
  for (double t = 0.0; t <= 2.0; t += 0.05) {
    const HandWaypoint at = hand_target(kPath, false, t);
    EXPECT_NEAR(at.position_m.y / 20_mm + at.position_m.z / 60_mm, 1.0, 1e-12);
    EXPECT_NEAR(at.grip_ratio, at.position_m.y / 20_mm, 1e-12);
  }
}

TEST(HandPath, HoldsItsLastWaypointOrStartsOver) {
  EXPECT_EQ(hand_target(kPath, false, 1e6).position_m, kPath.back().position_m);
  for (const double t : {0.3, 1.0, 2.5, 4.9}) {
    EXPECT_NEAR(norm(hand_target(kPath, true, t + 3 * 5.0).position_m -
                     hand_target(kPath, true, t).position_m),
                0.0, 1e-12);
  }
}

TEST(HandPath, WaitsAtItsFirstWaypointBeforeTheStart) {
  EXPECT_EQ(hand_target(kPath, true, -1.0).position_m, kPath.front().position_m);
}

TEST(HandPath, GivesAFinitePlaceForEveryTime) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const bool repeat : {false, true})
    for (const double t : {std::nan(""), kInf, -kInf, 1e300, -1e300, 5e-324})
      EXPECT_TRUE(is_finite(hand_target(kPath, repeat, t).position_m)) << t << repeat;
}

TEST(HandPath, RestsWithOneWaypointAndAtTheOriginWithNone) {
  const std::vector<HandWaypoint> one{{.position_m = {1_mm, 2_mm, 3_mm}}};
  for (const double t : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(hand_target(one, true, t).position_m, one[0].position_m);
    EXPECT_EQ(hand_target({}, true, t).position_m, Vec3{});
  }
}

TEST(HandPath, NeverUsesTheHeap) {
  const tests::NoAlloc guard;
  double sum_m = 0.0;
  for (double t = -1.0; t < 20.0; t += 0.01) sum_m += hand_target(kPath, true, t).position_m.z;
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_GT(sum_m, 0.0);
}

}  // namespace tact::model::hand_path_test
