// SPDX-License-Identifier: Apache-2.0
#include "host/figure/ccd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tact::host::figure::ccd_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using std::numbers::pi;

using Joints = std::vector<JointState>;

/// Shoulder (ball), elbow (hinge), wrist (ball): the arm that holds the probe.
Chain arm() {
  const Vector3d down = -Vector3d::UnitY();
  Bone shoulder{.kind = JointKind::kBall, .length_m = 0.3, .rest = down};
  shoulder.cone_rad = 2.6;
  Bone elbow{.length_m = 0.27, .rest = down, .hinge = Vector3d::UnitX()};
  elbow.lo_rad = -2.6, elbow.hi_rad = -0.05;
  Bone wrist{.kind = JointKind::kBall, .length_m = 0.18, .rest = down};
  wrist.cone_rad = 0.9;
  return {.base_m = {0.2, 1.4, 0.0}, .bones = {shoulder, elbow, wrist}};
}
Joints arm_start() { return {JointState{}, JointState{.angle_rad = -0.6}, JointState{}}; }

Chain planar(std::initializer_list<double> lengths_m, double lo_rad = -pi, double hi_rad = pi) {
  Chain chain;
  for (const double length_m : lengths_m)
    chain.bones.push_back(planar_bone(length_m, lo_rad, hi_rad));
  return chain;
}

Joints angles(std::initializer_list<double> angles_rad) {
  Joints joints;
  for (const double a : angles_rad) joints.push_back({.angle_rad = a});
  return joints;
}

std::vector<Vector3d> targets(int count, double spread_m) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> side(-spread_m, spread_m);
  std::vector<Vector3d> out(static_cast<std::size_t>(count));
  for (Vector3d& at : out) at = Vector3d(side(random), 1.2 + side(random), side(random));
  return out;
}

TEST(Ccd, MatchesPenAndPaper) {
  // A straight pair of unit bones, target (1, 1): the outer joint alone turns by a quarter.
  const ReachResult at = reach(planar({1.0, 1.0}), angles({0.0, 0.0}), {.target_m = {1, 1, 0}});
  EXPECT_EQ(at.status, ReachStatus::kConverged);
  EXPECT_EQ(at.updates, 1);
  EXPECT_NEAR(at.joints[0].angle_rad, 0.0, 1e-15);
  EXPECT_NEAR(at.joints[1].angle_rad, pi / 2.0, 1e-15);
  EXPECT_LT((at.points_m[2] - Vector3d(1, 1, 0)).norm(), 1e-15);
}

TEST(Ccd, KeepsBoneLengthsAndLimitsWhereverTheTargetIs) {
  const Chain chain = arm();
  Joints now = arm_start();
  for (const Vector3d& target_m : targets(300, 1.0)) {
    const ReachResult at = reach(chain, now, {.target_m = target_m});
    ASSERT_NE(at.status, ReachStatus::kInvalid);  // where it left off is a start
    for (std::size_t i = 0; i < chain.bones.size(); ++i)
      EXPECT_NEAR((at.points_m[i + 1] - at.points_m[i]).norm(), chain.bones[i].length_m, 1e-14);
    EXPECT_LE(swing_rad(chain.bones[0], at.joints[0]), 2.6 + 1e-12);
    EXPECT_GE(at.joints[1].angle_rad, -2.6);
    EXPECT_LE(at.joints[1].angle_rad, -0.05);
    EXPECT_LE(swing_rad(chain.bones[2], at.joints[2]), 0.9 + 1e-12);
    EXPECT_LE(at.sweeps, 20);
    EXPECT_EQ(at.status == ReachStatus::kConverged, at.error_m <= 1e-3);
    now = at.joints;
  }
}

TEST(Ccd, AFreeJointPointsTheEndAtTheTargetHoweverItsParentsAreTurned) {
  Chain chain = arm();
  chain.bones[2].cone_rad = pi;
  Joints start = arm_start();
  start[0].rotation = Quaterniond(0.8, 0.4, 0.4, 0.2);
  start[2].rotation = Quaterniond(0.5, -0.5, 0.5, 0.5);
  const Vector3d wrist_m = joint_points_m(chain, start)[2];
  for (const Vector3d& target_m : targets(20, 1.0)) {
    const ReachResult at = reach(chain, start, {.target_m = target_m, .sweeps = 1, .root = 2});
    EXPECT_EQ(at.points_m[2], wrist_m);
    EXPECT_NEAR(at.error_m, std::abs((target_m - wrist_m).norm() - 0.18), 1e-14);
  }
}

TEST(Ccd, AnotherSweepNeverLeadsAwayFromTheTargetWithHinges) {
  Chain chain = planar({0.3, 0.25, 0.2, 0.1}, -1.5, 1.5);
  Eigen::Index axis = 0;
  for (Bone& bone : chain.bones) bone.hinge = Vector3d::Unit(axis++ % 3) + Vector3d::UnitZ();
  for (const Vector3d& target_m : targets(40, 0.6)) {
    double last_m = 1e9;
    for (int sweeps = 0; sweeps < 12; ++sweeps) {
      const ReachResult at = reach(chain, angles({0.1, 0.2, -0.3, 0.4}),
                                   {.target_m = target_m - Vector3d(0, 1.2, 0), .sweeps = sweeps});
      EXPECT_LE(at.error_m, last_m + 1e-14);
      last_m = at.error_m;
    }
  }
}

TEST(Ccd, AChainOfHingesAboutZStaysInItsPlane) {
  const Chain chain = planar({0.3, 0.25, 0.2});
  const ReachResult at = reach(chain, angles({0.3, 0.4, 0.5}),
                               {.target_m = {-0.2, 0.3, 0.0}, .tolerance_m = 1e-9, .sweeps = 300});
  EXPECT_EQ(at.status, ReachStatus::kConverged);
  for (const Vector3d& p : at.points_m) EXPECT_EQ(p.z(), 0.0);
}

// X21  "CCD converges": not a straight chain that points at its target.
TEST(Ccd, AStraightChainThatPointsAtItsTargetStalls) {
  // The source claims no exception. Every joint already sees the end in line with the target.
  const Reach goal{.target_m = {0.4, 0.0, 0.0}, .sweeps = 200};
  const ReachResult stalled = reach(planar({0.3, 0.27}), angles({0.0, 0.0}), goal);
  EXPECT_EQ(stalled.status, ReachStatus::kMaxIterations);
  EXPECT_NEAR(stalled.error_m, 0.17, 1e-15);
  EXPECT_EQ(stalled.joints[1].angle_rad, 0.0);
  // An elbow that never straightens is the remedy.
  Chain bent = planar({0.3, 0.27});
  bent.bones[1].lo_rad = 0.05;
  EXPECT_EQ(reach(bent, angles({0.0, 0.05}), goal).status, ReachStatus::kConverged);
}

TEST(Ccd, SaysWhenTheLengthsCannotSpanTheDistance) {
  const auto status = [](double x_m) {
    return reach(planar({0.5, 0.2}), angles({0.1, 0.4}), {.target_m = {x_m, 0, 0}}).status;
  };
  EXPECT_EQ(status(0.72), ReachStatus::kUnreachable);  // sum of lengths 0.7
  EXPECT_EQ(status(0.28), ReachStatus::kUnreachable);  // 2 * 0.5 - 0.7 = 0.3 remains
  EXPECT_EQ(status(0.5), ReachStatus::kConverged);
  // A target behind the limits is not out of reach by this rule.
  const Chain stiff = planar({0.3, 0.27}, 0.0, 0.2);
  EXPECT_EQ(reach(stiff, angles({0.0, 0.1}), {.target_m = {0.0, 0.5, 0.0}}).status,
            ReachStatus::kMaxIterations);
}

TEST(Ccd, StartsAtTheShoulderWhenTheArmIsLongEnough) {
  const Chain body = planar({0.15, 0.2, 0.3, 0.27}, -2.5, 2.6);  // two of the trunk, two of the arm
  const Joints start = angles({1.2, -0.9, -0.5, 0.8});
  const Vector3d shoulder_m = joint_points_m(body, start)[2];
  const Vector3d ray = Vector3d(0.6, -0.8, 0.0) * 0.57;
  EXPECT_EQ(choose_root(body, start, 2, shoulder_m + 0.97 * ray), 2u);
  EXPECT_EQ(choose_root(body, start, 2, shoulder_m + 0.99 * ray), 0u);

  const Vector3d target_m = shoulder_m + 0.6 * ray;
  const ReachResult arm_only = reach(body, start, {.target_m = target_m, .sweeps = 100, .root = 2});
  const ReachResult whole = reach(body, start, {.target_m = target_m, .sweeps = 100});
  EXPECT_EQ(arm_only.status, ReachStatus::kConverged);
  EXPECT_EQ(whole.status, ReachStatus::kConverged);
  EXPECT_EQ(arm_only.joints[0].angle_rad, 1.2);  // the trunk stays
  EXPECT_EQ(arm_only.joints[1].angle_rad, -0.9);
  EXPECT_EQ(arm_only.points_m[2], shoulder_m);
  EXPECT_NE(whole.joints[0].angle_rad, 1.2);
  EXPECT_LT(arm_only.updates, whole.updates);
}

TEST(Ccd, ABallTurnsByExactlyHalfATurnWhenItMust) {
  for (const Vector3d& rest : {Vector3d(0, -1, 0), Vector3d(0, 0, 2), Vector3d(1, 1, 1)}) {
    Chain chain{.base_m = {0.2, 1.4, 0.0}, .bones = {{.kind = JointKind::kBall, .length_m = 0.3}}};
    chain.bones[0].rest = rest;
    const Vector3d target_m = chain.base_m - 0.3 * rest.normalized();
    const ReachResult at = reach(chain, Joints(1), {.target_m = target_m});
    EXPECT_EQ(at.status, ReachStatus::kConverged);
    EXPECT_NEAR(swing_rad(chain.bones[0], at.joints[0]), pi, 1e-12);
  }
}

TEST(Ccd, InvalidChainStartOrGoalIsRefused) {
  const double nan = std::nan("");
  const auto status = [](auto change) {
    Chain chain = arm();
    Joints start = arm_start();
    Reach goal{.target_m = {0.1, 1.2, 0.3}};
    change(chain, start, goal);
    return reach(chain, start, goal).status;
  };
  const auto refused = [&](auto change) { return status(change) == ReachStatus::kInvalid; };
  EXPECT_FALSE(refused([](auto&, auto&, auto&) {}));
  EXPECT_TRUE(refused([](auto& c, auto&, auto&) { c.bones.clear(); }));
  EXPECT_TRUE(refused([](auto& c, auto&, auto&) { c.bones[1].length_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& c, auto&, auto&) { c.bones[1].hinge.setZero(); }));
  EXPECT_TRUE(refused([](auto& c, auto&, auto&) { c.bones[2].rest.setZero(); }));
  EXPECT_TRUE(refused([&](auto& c, auto&, auto&) { c.base_m[0] = nan; }));
  EXPECT_TRUE(refused([&](auto& c, auto&, auto&) { c.bones[0].cone_rad = nan; }));
  EXPECT_TRUE(refused([](auto&, auto& s, auto&) { s.pop_back(); }));
  EXPECT_TRUE(refused([](auto&, auto& s, auto&) { s[1].angle_rad = 0.0; }));  // beyond its limit
  EXPECT_TRUE(refused([&](auto&, auto& s, auto&) { s[1].angle_rad = nan; }));
  EXPECT_TRUE(refused([](auto&, auto& s, auto&) { s[2].rotation = Quaterniond(0, 1, 0, 0); }));
  EXPECT_TRUE(refused([](auto&, auto& s, auto&) { s[0].rotation = Quaterniond(2, 0, 0, 0); }));
  EXPECT_TRUE(refused([&](auto&, auto&, auto& g) { g.target_m[1] = nan; }));
  EXPECT_TRUE(refused([](auto&, auto&, auto& g) { g.tolerance_m = 0.0; }));
  EXPECT_TRUE(refused([](auto&, auto&, auto& g) { g.sweeps = kMaxSweeps + 1; }));
  EXPECT_TRUE(refused([](auto&, auto&, auto& g) { g.root = 3; }));
  EXPECT_EQ(status([](auto&, auto&, auto& g) { g.target_m[0] = 1e300; }),
            ReachStatus::kUnreachable);
}

}  // namespace tact::host::figure::ccd_test
