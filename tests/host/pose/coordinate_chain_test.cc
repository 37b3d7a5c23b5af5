// SPDX-License-Identifier: Apache-2.0
#include "host/pose/coordinate_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace tact::host::pose::coordinate_chain_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
constexpr double kQuarter_rad = std::numbers::pi / 2.0;

Pose pose(const EulerAngles& angles, const Vector3d& position_m) {
  return {.rotation = rotation_from(angles), .position_m = position_m};
}

void expect_near(const Vector3d& got, const Vector3d& want, double tolerance) {
  EXPECT_LT((got - want).norm(), tolerance) << got.transpose() << " for " << want.transpose();
}

void expect_same(const Pose& got, const Pose& want, double tolerance) {
  expect_near(got.position_m, want.position_m, tolerance);
  EXPECT_LT(got.rotation.angularDistance(want.rotation), tolerance);
}

const Pose tracker_then = pose({0.3, -0.7, 1.9}, {0.1, 1.2, -0.4});
const Pose bone_then = pose({-1.1, 0.2, 0.5}, {0.3, 1.0, -0.1});
const Pose tracker_now = pose({2.0, 0.4, -2.5}, {-0.6, 0.9, 0.8});

TEST(CoordinateChain, MatchesPenAndPaper) {
  // A quarter turn about x takes z to -y; the quarter turn about z that follows takes -y to x.
  const Pose local = pose({.alpha_rad = kQuarter_rad, .beta_rad = 0.0, .gamma_rad = kQuarter_rad},
                          {10.0, 20.0, 30.0});
  expect_near(to_world(local, Vector3d::UnitZ()), {11.0, 20.0, 30.0}, 1e-14);
  expect_near(to_local(local, {11.0, 20.0, 30.0}), Vector3d::UnitZ(), 1e-14);
  // qz qx = (1 + k)(1 + i) / 2 = (1 + i + j + k) / 2
  const Vector3d half = Vector3d::Constant(0.5);
  expect_near(local.rotation.vec(), half, 1e-15);
  EXPECT_NEAR(local.rotation.w(), 0.5, 1e-15);
}

TEST(CoordinateChain, CanonicalQuaternionIsTheSameForBothSigns) {
  for (const Quaterniond& q : {Quaterniond(0.5, -0.5, 0.5, -0.5), Quaterniond(0, 1, 0, 0),
                               Quaterniond(0, 0, 0.6, -0.8), Quaterniond(0, 0, 0, 1)}) {
    EXPECT_EQ(canonical(q).coeffs(), q.coeffs());
    EXPECT_EQ(canonical(Quaterniond(-q.coeffs())).coeffs(), q.coeffs());
  }
}

TEST(CoordinateChain, ABoneIsWhereItWasBoundAndMovesRigidlyWithItsTracker) {
  const Pose offset = bind(tracker_then, bone_then);
  expect_same(drive(tracker_then, offset), bone_then, 1e-14);
  // What the tracker sees of the bone never changes.
  const Pose bone = drive(tracker_now, offset);
  expect_same(bind(tracker_now, bone), offset, 1e-14);
  EXPECT_NEAR((bone.position_m - tracker_now.position_m).norm(),
              (bone_then.position_m - tracker_then.position_m).norm(), 1e-14);
}

TEST(CoordinateChain, MovingTheWorldMovesTheBoneAlike) {
  const Pose world = pose({-0.2, 1.3, 0.8}, {5.0, -3.0, 1.0});
  const Pose offset = bind(tracker_then, bone_then);
  // drive(A, B) is "A after B": carrying the tracker elsewhere carries the bone there too.
  expect_same(drive(drive(world, tracker_now), offset), drive(world, drive(tracker_now, offset)),
              1e-14);
}

TEST(CoordinateChain, BetweenTakesTheShorterWayForAnySigns) {
  Pose to = bone_then;
  for (int sign = 0; sign < 2; ++sign) {
    expect_same(between(tracker_then, to, 0.0), tracker_then, 1e-14);
    expect_same(between(tracker_then, to, 1.0), bone_then, 1e-14);
    const Pose middle = between(tracker_then, to, 0.5);
    const double whole_rad = tracker_then.rotation.angularDistance(bone_then.rotation);
    EXPECT_NEAR(middle.rotation.angularDistance(tracker_then.rotation), whole_rad / 2.0, 1e-14);
    EXPECT_NEAR(middle.rotation.angularDistance(bone_then.rotation), whole_rad / 2.0, 1e-14);
    expect_near(middle.position_m, (tracker_then.position_m + bone_then.position_m) / 2.0, 1e-15);
    to.rotation.coeffs() *= -1.0;
  }
}

TEST(CoordinateChain, FourNumbersAreARotationOnlyIfTheyHaveADirection) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(rotation_from({0, 0, 0, 0}));
  EXPECT_FALSE(rotation_from({nan, 0, 0, 1}));
  EXPECT_FALSE(rotation_from({inf, 0, 0, 1}));
  for (const double scale : {1e-300, 1.0, 1e300}) {
    const auto q = rotation_from({-3.0 * scale, 0.0, 4.0 * scale, 0.0});
    ASSERT_TRUE(q);
    EXPECT_NEAR(q->w(), 0.6, 1e-15);
    EXPECT_NEAR(q->y(), -0.8, 1e-15);
  }
}

}  // namespace tact::host::pose::coordinate_chain_test
