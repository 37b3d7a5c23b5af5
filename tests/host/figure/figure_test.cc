// SPDX-License-Identifier: Apache-2.0
#include "host/figure/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/operator_motion.h"

namespace tact::host::figure::figure_test {

using Eigen::Vector3d;
using test::bodies_at;
using test::kMotion_s;
using test::kMotionFrame_s;
using test::tool_at;
using test::troubled_bodies_at;

/// Calls `see(t_s, pose, figure)` for every frame of the whole motion.
template <typename Bodies, typename See>
void play(Figure& figure, const Bodies& bodies, const See& see) {
  for (double t_s = 0.0; t_s < kMotion_s; t_s += kMotionFrame_s)
    see(t_s, figure.update(t_s, tool_at(t_s), bodies(t_s)));
}

double angle_rad(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TrackedOperator untracked(double) { return {}; }

/// Every bone that the plan names.
std::array<std::pair<std::array<FigureJoint, 2>, double>, 21> bones(const BodyPlan& plan) {
  using enum FigureJoint;
  return {{{{kPelvis, kBack}, plan.lumbar_m},
           {{kBack, kChest}, plan.thorax_m},
           {{kChest, kHead}, plan.neck_m},
           {{kHead, kCrown}, plan.head_m},
           {{kChest, kLeftShoulder}, plan.clavicle_m},
           {{kLeftShoulder, kLeftElbow}, plan.upper_arm_m},
           {{kLeftElbow, kLeftWrist}, plan.forearm_m},
           {{kLeftWrist, kLeftKnuckles}, plan.palm_m},
           {{kLeftKnuckles, kLeftFingers}, plan.fingers_m},
           {{kChest, kRightShoulder}, plan.clavicle_m},
           {{kRightShoulder, kRightElbow}, plan.upper_arm_m},
           {{kRightElbow, kRightWrist}, plan.forearm_m},
           {{kRightWrist, kRightKnuckles}, plan.palm_m},
           {{kRightKnuckles, kRightFingers}, plan.fingers_m},
           {{kPelvis, kRightHip}, plan.half_hips_m},
           {{kLeftHip, kLeftKnee}, plan.thigh_m},
           {{kLeftKnee, kLeftAnkle}, plan.calf_m},
           {{kLeftAnkle, kLeftToes}, plan.foot_m},
           {{kRightHip, kRightKnee}, plan.thigh_m},
           {{kRightKnee, kRightAnkle}, plan.calf_m},
           {{kRightAnkle, kRightToes}, plan.foot_m}}};
}

TEST(Figure, KeepsEveryBoneLengthThroughLossesAndJumps) {
  Figure figure;
  play(figure, troubled_bodies_at, [&](double t_s, const FigurePose& pose) {
    for (const auto& [ends, length_m] : bones(figure.plan())) {
      ASSERT_NEAR((pose[ends[1]] - pose[ends[0]]).norm(), length_m, 1e-9)
          << kFigureJointNames[static_cast<std::size_t>(ends[1])] << " at " << t_s << " s";
    }
  });
}

TEST(Figure, KeepsEveryLimitThroughLossesAndJumps) {
  Figure figure;
  play(figure, troubled_bodies_at, [&](double, const FigurePose& pose) {
    const Chain& chain = figure.arm().chain();
    for (std::size_t i = 0; i < chain.bones.size(); ++i) {
      const Bone& bone = chain.bones[i];
      const double swing = swing_rad(bone, figure.arm().joints()[i]);
      const bool hinge = bone.kind == JointKind::kHinge;
      ASSERT_GE(swing, hinge ? bone.lo_rad : 0.0) << i;
      ASSERT_LE(swing, (hinge ? bone.hi_rad : bone.cone_rad) + 1e-9) << i;
    }
    const Vector3d spine = pose[FigureJoint::kChest] - pose[FigureJoint::kBack];
    const Vector3d neck = pose[FigureJoint::kHead] - pose[FigureJoint::kChest];
    ASSERT_LE(angle_rad(spine, neck), kNeckCone_rad + 1e-6);
  });
}

TEST(Figure, BendsAndTurnsTheNeckNoFartherThanANeckGoes) {
  Figure figure;
  TrackedOperator bodies;
  TrackedBody& head = bodies[BodyRole::kHead];
  head.state = BodyState::kTracked;
  head.pose.position_m = {0.4, -0.08, 0.56};
  figure.update(0.0, tool_at(0.0), bodies);
  head.pose.position_m += Vector3d(0.3, 0.6, -0.5);  // far off, and it looks back
  head.pose.rotation = Eigen::AngleAxisd(3.0, Vector3d::UnitZ());
  for (int i = 1; i < 300; ++i) figure.update(i * kMotionFrame_s, tool_at(0.0), bodies);
  const FigurePose& pose = figure.pose();
  const Vector3d spine = pose[FigureJoint::kChest] - pose[FigureJoint::kBack];
  EXPECT_NEAR(angle_rad(spine, pose[FigureJoint::kHead] - pose[FigureJoint::kChest]), kNeckCone_rad,
              1e-6);
  const Eigen::Quaterniond thorax = figure.arm().axes(kThoraxBone);
  EXPECT_NEAR(thorax.angularDistance(pose.head), kHeadTurn_rad, 1e-6);
}

TEST(Figure, HoldsTheToolWithinAMillimetreForAnyTrackers) {
  for (const auto bodies : {untracked, bodies_at, troubled_bodies_at}) {
    Figure figure;
    play(figure, bodies, [&](double t_s, const FigurePose& pose) {
      const Vector3d grip_m = pose::to_world(tool_at(t_s), FigureSettings{}.grip_m);
      ASSERT_LT((pose[FigureJoint::kRightFingers] - grip_m).norm(), 1e-3) << t_s;
      ASSERT_TRUE(pose.arm.reached) << t_s;
      ASSERT_LE(pose.arm.sweeps, 2 * kSweeps);
    });
  }
}

TEST(Figure, TurnsTheHandWithTheToolWhereTheWristLetsIt) {
  Figure figure;
  const Vector3d palm = holding_hand() * arm_along();
  double most_rad = 0.0;
  play(figure, untracked, [&](double t_s, const FigurePose& pose) {
    const Vector3d now = pose[FigureJoint::kRightKnuckles] - pose[FigureJoint::kRightWrist];
    const Vector3d wanted = tool_at(t_s).rotation * palm;
    if (t_s > 0.5) most_rad = std::max(most_rad, angle_rad(now, wanted));
  });
  EXPECT_LT(most_rad, 0.15);
}

/// The fastest joint of a motion, but for those of the arm that follow the tool's own speed.
double fastest_mps(const std::function<TrackedOperator(double)>& bodies) {
  Figure figure;
  FigurePose before = figure.update(0.0, tool_at(0.0), bodies(0.0));
  double most_mps = 0.0;
  play(figure, bodies, [&](double, const FigurePose& pose) {
    for (std::size_t i = 0; i < kFigureJoints; ++i)
      most_mps = std::max(most_mps, (pose.joint_m[i] - before.joint_m[i]).norm() / kMotionFrame_s);
    before = pose;
  });
  return most_mps;
}

TEST(Figure, NeverJumps) {
  const double calm_mps = fastest_mps(untracked), tracked_mps = fastest_mps(bodies_at),
               troubled_mps = fastest_mps(troubled_bodies_at);
  std::printf("fastest joint: tool alone %.2f m/s, tracked %.2f m/s, with losses %.2f m/s\n",
              calm_mps, tracked_mps, troubled_mps);
  EXPECT_GT(calm_mps, 0.1);
  EXPECT_LT(calm_mps, 0.6);
  EXPECT_LT(tracked_mps, 0.6);
  EXPECT_LT(troubled_mps, 1.6);
}

TEST(Figure, HoldsFadesAndComesBackWithItsTracker) {
  // The head moves 5 cm to the side; then its tracker falls silent.
  const auto head_at = [](double y_m, BodyState state) {
    TrackedOperator bodies;
    bodies[BodyRole::kHead].state = state;
    bodies[BodyRole::kHead].pose.position_m = {0.4, y_m, 0.56};
    return bodies;
  };
  Figure figure;
  double t_s = 0.0;
  const auto run_s = [&](double duration_s, const TrackedOperator& bodies) {
    for (double end_s = t_s + duration_s; t_s < end_s; t_s += kMotionFrame_s)
      figure.update(t_s, tool_at(0.0), bodies);
    return figure.pose()[FigureJoint::kHead].y();
  };
  const double neutral_m = run_s(10.0, {});
  EXPECT_NEAR(run_s(0.5, head_at(0.10, BodyState::kTracked)), neutral_m, 1e-3);
  const double moved_m = run_s(1.0, head_at(0.15, BodyState::kTracked));
  EXPECT_NEAR(moved_m, neutral_m + 0.05, 2e-3);
  EXPECT_NEAR(run_s(0.4, head_at(9.0, BodyState::kHeld)), moved_m, 1e-3);
  EXPECT_EQ(figure.pose().words, "head held (no pose)");
  const double fading_m = run_s(0.5, head_at(9.0, BodyState::kLost));
  EXPECT_GT(fading_m, neutral_m + 0.01);
  EXPECT_LT(fading_m, moved_m - 0.01);
  run_s(9.0, head_at(9.0, BodyState::kLost));
  EXPECT_NEAR(figure.pose()[FigureJoint::kHead].y(), neutral_m, 1e-3);
  EXPECT_NEAR(run_s(0.5, head_at(0.15, BodyState::kTracked)), moved_m, 3e-3);
}

TEST(Figure, ShoulderOfTheFigureFollowsTheTrackedShoulder) {
  Figure figure;
  TrackedOperator bodies;
  bodies[BodyRole::kShoulder].state = BodyState::kTracked;
  bodies[BodyRole::kShoulder].pose.position_m = {0.50, 0.20, 0.40};
  bodies[BodyRole::kHead].state = BodyState::kLost;  // described, not seen yet
  for (int i = 0; i < 120; ++i) figure.update(i * kMotionFrame_s, tool_at(0.0), bodies);
  const FigurePose& pose = figure.pose();
  EXPECT_LT((pose[FigureJoint::kRightShoulder] - Vector3d(0.50, 0.20, 0.40)).norm(), 2e-3);
  EXPECT_LT((pose[FigureJoint::kRightAnkle] - pose[FigureJoint::kPelvis]).head<2>().norm(), 0.15)
      << "the feet come along";

  bodies[BodyRole::kShoulder].pose.position_m = {40.0, 0.0, 0.0};  // not registered: elsewhere
  Figure stays;
  const Vector3d before_m = stays.pose()[FigureJoint::kPelvis];
  for (int i = 0; i < 120; ++i) stays.update(i * kMotionFrame_s, tool_at(0.0), bodies);
  EXPECT_LT((stays.pose()[FigureJoint::kPelvis] - before_m).norm(), 1e-12);
}

TEST(Figure, RestsOnUntrackedLegs) {
  Figure figure;
  const FigurePose first = figure.pose();
  TrackedOperator bodies;
  play(
      figure,
      [&](double t_s) {
        bodies[BodyRole::kWaist] = test::sways({0.4, -0.08, -0.13}, 0.03, t_s);
        return bodies;
      },
      [&](double, const FigurePose& pose) {
        for (const FigureJoint foot : {FigureJoint::kLeftAnkle, FigureJoint::kRightAnkle}) {
          const auto i = static_cast<std::size_t>(foot);
          ASSERT_LT((pose.joint_m[i] - first.joint_m[i]).norm(), 1e-9);
        }
      });
}

TEST(Figure, PointsAtAToolThatItCannotReachAndSaysSo) {
  Figure figure;
  Pose tool;
  tool.position_m = {-2.0, 0.4, 0.3};
  for (int i = 0; i < 300; ++i) figure.update(i * kMotionFrame_s, tool, {});
  const FigurePose& pose = figure.pose();
  EXPECT_TRUE(pose.arm.out_of_reach);
  EXPECT_EQ(pose.trouble, FigureTrouble::kOutOfReach);
  EXPECT_EQ(pose.words, "the arm cannot reach the tool");
  const Vector3d arm = pose[FigureJoint::kRightFingers] - pose[FigureJoint::kRightShoulder];
  const Vector3d way = pose.grip_m - pose[FigureJoint::kRightShoulder];
  EXPECT_LT(angle_rad(arm, way), 0.1);
  EXPECT_GT(arm.norm(), 0.95 * (figure.plan().upper_arm_m + figure.plan().forearm_m));
}

TEST(Figure, SaysWhichBodyIsLostAndWhy) {
  Figure figure;
  TrackedOperator bodies = bodies_at(0.0);
  EXPECT_EQ(figure.update(0.0, tool_at(0.0), bodies).words, "");
  bodies[BodyRole::kLeftAnkle].state = BodyState::kHeld;
  bodies[BodyRole::kLeftAnkle].trouble = TrackingTrouble::kJump;
  EXPECT_EQ(figure.update(0.1, tool_at(0.0), bodies).words, "left ankle held (it jumps)");
  bodies[BodyRole::kHead].state = BodyState::kLost;
  bodies[BodyRole::kHead].trouble = TrackingTrouble::kSilent;
  EXPECT_EQ(figure.update(0.2, tool_at(0.0), bodies).words, "head lost (silent)");
  EXPECT_EQ(figure.pose().trouble, FigureTrouble::kLost);
}

TEST(Figure, LetsNoNumberOutThatIsNotFinite) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  Figure figure;
  play(
      figure,
      [&](double t_s) {
        TrackedOperator bodies = bodies_at(t_s);
        for (std::size_t i = 0; i < kBodyRoles; ++i) {
          Pose& pose = bodies.bodies[i].pose;
          const int kind = static_cast<int>(t_s * 10.0 + static_cast<double>(i)) % 4;
          if (kind == 0) pose.position_m[1] = none;
          if (kind == 1) pose.rotation.coeffs()[static_cast<int>(i) % 4] = none;
          if (kind == 2) pose.position_m[0] = std::numeric_limits<double>::infinity();
        }
        return bodies;
      },
      [&](double t_s, const FigurePose& pose) {
        for (const Vector3d& at_m : pose.joint_m) ASSERT_TRUE(at_m.allFinite()) << t_s;
        ASSERT_TRUE(pose.head.coeffs().allFinite());
      });
  Pose tool = tool_at(0.0);
  const FigurePose before = figure.update(40.0, tool, {});
  tool.position_m[0] = none;
  const FigurePose& after = figure.update(40.0, tool, {});
  EXPECT_LT((after.grip_m - before.grip_m).norm(), 1e-12) << "the last good one is kept";
}

TEST(Figure, BeginsAgainWhenTimeGoesBack) {
  Figure figure, fresh;
  play(figure, bodies_at, [](double, const FigurePose&) {});
  const FigurePose again = figure.update(1.0, tool_at(1.0), bodies_at(1.0));
  const FigurePose& first = fresh.update(1.0, tool_at(1.0), bodies_at(1.0));
  for (std::size_t i = 0; i < kFigureJoints; ++i)
    EXPECT_EQ(again.joint_m[i], first.joint_m[i]) << kFigureJointNames[i];
}

}  // namespace tact::host::figure::figure_test
