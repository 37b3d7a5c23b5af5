// SPDX-License-Identifier: Apache-2.0
#include "host/figure/tool_arm.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/support/operator_motion.h"

namespace tact::host::figure::tool_arm_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const BodyPlan kPlan = make_body_plan(1.75);

/// A grip in front of the body, in the pelvis's axes; the hand as it holds a tool.
ArmGoal goal(double x_m, double y_m, double z_m) {
  return {.grip_m = {x_m, y_m, z_m}, .hand = holding_hand()};
}

TEST(ToolArm, LeavesTheTrunkAloneWhereTheArmIsLongEnough) {
  ToolArm arm(kPlan);
  const ArmWork work = arm.hold(goal(-0.40, 0.09, 0.22));
  EXPECT_TRUE(work.reached);
  EXPECT_FALSE(work.full_chain);
  const Vector3d shoulder_m = upright_m(kPlan, FigureJoint::kRightShoulder);
  EXPECT_LT((arm.points_m()[kShoulderBone] - shoulder_m).norm(), 1e-12);
}

TEST(ToolArm, LeansWhereTheArmIsTooShort) {
  ToolArm arm(kPlan);
  const ArmWork work = arm.hold(goal(-0.85, 0.0, 0.25));
  EXPECT_TRUE(work.reached);
  EXPECT_TRUE(work.full_chain);
  const Vector3d shoulder_m = upright_m(kPlan, FigureJoint::kRightShoulder);
  EXPECT_GT((arm.points_m()[kShoulderBone] - shoulder_m).norm(), 0.05);
}

TEST(ToolArm, BringsTheTrunkInWhereALimitOfTheArmIsInTheWay) {
  // Behind the shoulder: near enough, but the upper arm's cone does not let the arm go there.
  const Vector3d shoulder_m = upright_m(kPlan, FigureJoint::kRightShoulder);
  for (const Vector3d& behind_m :
       {Vector3d(0.30, 0.0, 0.0), Vector3d(0.30, 0.0, 0.10), Vector3d(0.40, 0.0, 0.0)}) {
    ToolArm arm(kPlan);
    const Vector3d at_m = shoulder_m + behind_m;
    ASSERT_EQ(choose_root(arm.chain(), arm.joints(), kShoulderBone, at_m), kShoulderBone);
    const ArmWork work = arm.hold(goal(at_m.x(), at_m.y(), at_m.z()));
    EXPECT_TRUE(work.reached);
    EXPECT_TRUE(work.full_chain);
    EXPECT_FALSE(work.out_of_reach);
    EXPECT_GT(work.sweeps, kSweeps) << "what the arm alone tried in vain counts, too";
    EXPECT_GT((arm.points_m()[kShoulderBone] - shoulder_m).norm(), 0.02);
  }
}

TEST(ToolArm, BeginsWhereTheLastFrameEnded) {
  for (const RootRule rule : {RootRule::kSubRootFirst, RootRule::kAlwaysFullChain}) {
    for (const ArmGoal& same : {goal(-0.40, 0.09, 0.22), goal(-0.85, 0.0, 0.25)}) {
      ToolArm arm(kPlan, rule);
      EXPECT_GT(arm.hold(same).updates, 0);
      const auto before = arm.points_m();
      const ArmWork again = arm.hold(same);
      EXPECT_TRUE(again.reached);
      EXPECT_EQ(again.sweeps, 0);
      EXPECT_EQ(again.updates, 0);
      for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_LT((arm.points_m()[i] - before[i]).norm(), 1e-12) << i;
    }
  }
}

TEST(ToolArm, NeitherElbowNorShoulderJumpsBetweenNeighbouringFrames) {
  const Vector3d pelvis_m = standing_pelvis(kPlan).position_m;
  for (const RootRule rule : {RootRule::kSubRootFirst, RootRule::kAlwaysFullChain}) {
    ToolArm arm(kPlan, rule);
    std::optional<std::array<Vector3d, ToolArm::kBones + 1>> before;
    double most_m = 0.0;
    for (double t_s = 0.0; t_s < test::kMotion_s; t_s += test::kMotionFrame_s) {
      const Pose tool = test::tool_at(t_s);
      arm.relax(0.01);
      arm.hold({.grip_m = pose::to_world(tool, {0.0, 0.0, 0.075}) - pelvis_m,
                .hand = (tool.rotation * holding_hand()).normalized()});
      for (const std::size_t i : {kShoulderBone, kElbowBone})
        if (before) most_m = std::max(most_m, (arm.points_m()[i] - (*before)[i]).norm());
      before = arm.points_m();
    }
    std::printf("most in a frame: %.2f mm\n", 1e3 * most_m);
    EXPECT_LT(most_m, 0.01);
    EXPECT_GT(most_m, 0.001);
  }
}

TEST(ToolArm, IsUprightAgainWhenTheToolComesBack) {
  ToolArm arm(kPlan);
  arm.hold(goal(-0.85, 0.0, 0.25));
  for (int i = 0; i < 600; ++i) {
    arm.relax(0.02);
    arm.hold(goal(-0.40, 0.09, 0.22));
  }
  const Vector3d shoulder_m = upright_m(kPlan, FigureJoint::kRightShoulder);
  EXPECT_LT((arm.points_m()[kShoulderBone] - shoulder_m).norm(), 1e-3);
}

TEST(ToolArm, KeepsLengthsAndLimitsForAnyGoal) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(-1.0, 1.0);
  ToolArm arm(kPlan);
  int reached = 0;
  for (int i = 0; i < 2000; ++i) {
    ArmGoal any = goal(-0.4 + 0.6 * side(random), 0.6 * side(random), 0.3 + 0.6 * side(random));
    any.hand = Quaterniond(side(random), side(random), side(random), side(random)).normalized();
    arm.relax(0.02);
    const ArmWork work = arm.hold(any);
    const double error_m = (arm.points_m().back() - any.grip_m).norm();
    ASSERT_NEAR(work.error_m, error_m, 1e-12);
    ASSERT_EQ(work.reached, error_m <= kGripTolerance_m);
    ASSERT_LE(work.sweeps, kMaxSweepsPerFrame);
    reached += work.reached;
    for (std::size_t k = 0; k < ToolArm::kBones; ++k) {
      const Bone& bone = arm.chain().bones[k];
      ASSERT_NEAR((arm.points_m()[k + 1] - arm.points_m()[k]).norm(), bone.length_m, 1e-12);
      const bool hinge = bone.kind == JointKind::kHinge;
      const double swing = swing_rad(bone, arm.joints()[k]);
      ASSERT_GE(swing, hinge ? bone.lo_rad : 0.0);
      ASSERT_LE(swing, (hinge ? bone.hi_rad : bone.cone_rad) + 1e-9);
    }
  }
  EXPECT_GT(reached, 1800) << "most of them are in reach";
  EXPECT_LT(reached, 2000) << "and some are not";
}

TEST(ToolArm, TurnsTheElbowToItsGoalUnlessALimitIsInTheWay) {
  int free = 0, by_cone = 0;
  // High and near the cone of the upper arm leaves the elbow no room above.
  for (const ArmGoal& same : {goal(-0.40, 0.09, 0.22), goal(-0.22, 0.12, 0.45)}) {
    ToolArm settled(kPlan);
    for (int i = 0; i < 100; ++i) settled.relax(0.05), settled.hold(same);
    for (double elbow_goal_rad = -3.0; elbow_goal_rad <= 3.0; elbow_goal_rad += 0.1) {
      ToolArm arm = settled;
      const auto before = arm.points_m();
      const Vector3d shoulder_m = before[kShoulderBone],
                     along = (before[kHandBone] - shoulder_m).normalized();
      const auto beside = [&](const Vector3d& p_m) -> Vector3d {
        return (p_m - shoulder_m) - (p_m - shoulder_m).dot(along) * along;
      };
      ArmGoal reported = same;
      reported.elbow_m = shoulder_m + Eigen::AngleAxisd(elbow_goal_rad, along) *
                                          (1.3 * beside(before[kElbowBone]));
      EXPECT_TRUE(arm.hold(reported).reached);
      const auto left_rad = [&](std::size_t i) {
        const Bone& bone = arm.chain().bones[i];
        return bone.cone_rad - swing_rad(bone, arm.joints()[i]);
      };
      EXPECT_GE(left_rad(kShoulderBone), -1e-9);
      const Vector3d now = beside(arm.points_m()[kElbowBone]), wanted = beside(*reported.elbow_m);
      const double off_rad = std::atan2(now.cross(wanted).norm(), now.dot(wanted));
      free += off_rad < 1e-6;
      by_cone += off_rad > 0.3 && left_rad(kShoulderBone) < 1e-3;
      // The wrist's limit is in the way of the hand; the elbow then gives a little.
      if (off_rad > 1e-6) EXPECT_LT(std::min(left_rad(kShoulderBone), left_rad(kHandBone)), 0.05);
    }
  }
  EXPECT_GT(free, 5);
  EXPECT_GT(by_cone, 5);
}

TEST(ToolArm, ANumberThatIsNotFiniteChangesNothing) {
  ToolArm arm(kPlan);
  arm.hold(goal(-0.40, 0.09, 0.22));
  const auto before = arm.points_m();
  EXPECT_FALSE(arm.hold(goal(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.2)).reached);
  EXPECT_EQ(arm.points_m(), before);
  ArmGoal no_elbow = goal(-0.40, 0.09, 0.22);
  no_elbow.elbow_m = Vector3d(0.0, std::numeric_limits<double>::infinity(), 0.0);
  EXPECT_TRUE(arm.hold(no_elbow).reached);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((arm.points_m()[i] - before[i]).norm(), 1e-12) << "of an elbow that is none";
}

struct Counted {
  long updates = 0;
  double worst_error_m = 0.0;
};

Counted count(RootRule rule) {
  ToolArm arm(kPlan, rule);
  const Vector3d pelvis_m = standing_pelvis(kPlan).position_m;
  Counted out;
  for (double t_s = 0.0; t_s < test::kMotion_s; t_s += test::kMotionFrame_s) {
    const Pose tool = test::tool_at(t_s);
    arm.relax(0.011);
    const ArmWork work = arm.hold({.grip_m = pose::to_world(tool, {0.0, 0.0, 0.075}) - pelvis_m,
                                   .hand = (tool.rotation * holding_hand()).normalized()});
    out.updates += work.updates;
    out.worst_error_m = std::max(out.worst_error_m, work.error_m);
  }
  return out;
}

/// Classical CCD of the wrist alone, warm from frame to frame.
long updates_of_ccd(std::size_t sub_root) {
  Chain chain = arm_chain(kPlan);
  chain.bones.resize(kHandBone);
  const auto rest = arm_at_rest();
  std::vector<JointState> joints(rest.begin(), rest.begin() + kHandBone);
  const Vector3d pelvis_m = standing_pelvis(kPlan).position_m;
  long updates = 0;
  for (double t_s = 0.0; t_s < test::kMotion_s; t_s += test::kMotionFrame_s) {
    const Vector3d wrist_m = pose::to_world(test::tool_at(t_s), {0.09, 0.05, 0.14}) - pelvis_m;
    const std::size_t root = sub_root == 0 ? 0 : choose_root(chain, joints, sub_root, wrist_m);
    const ReachResult result =
        reach(chain, joints, {.target_m = wrist_m, .tolerance_m = 0.3e-3, .root = root});
    joints = result.joints;
    updates += result.updates;
  }
  return updates;
}

TEST(ToolArm, CcdFromTheSubRootAloneWouldSaveNothing) {
  // Why the arm begins with the two-bone formula: fewer joints need more sweeps.
  EXPECT_GT(2 * updates_of_ccd(kShoulderBone), 3 * updates_of_ccd(0));
}

TEST(ToolArm, TurnsLessThanHalfTheJointsOfTheFullChainAtEqualError) {
  const Counted sub = count(RootRule::kSubRootFirst), full = count(RootRule::kAlwaysFullChain);
  const double ratio = static_cast<double>(full.updates) / static_cast<double>(sub.updates);
  std::printf("joint updates over 30 s: sub-root %ld, full chain %ld, ratio %.2f\n", sub.updates,
              full.updates, ratio);
  EXPECT_LE(sub.worst_error_m, kGripTolerance_m);
  EXPECT_LE(full.worst_error_m, kGripTolerance_m);
  EXPECT_GT(sub.updates, 1800);
  EXPECT_GE(ratio, 2.0);
}

}  // namespace tact::host::figure::tool_arm_test
