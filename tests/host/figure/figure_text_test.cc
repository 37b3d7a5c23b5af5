// SPDX-License-Identifier: Apache-2.0
#include "host/figure/figure_text.h"

#include <gtest/gtest.h>

#include "tests/support/operator_motion.h"

namespace tact::host::figure::figure_words_test {

using Eigen::Vector3d;

/// A figure whose ankle's tracker, once bound, goes up or down for a second.
FigurePose with_ankle(BodyRole role, double by_z_m) {
  Figure figure;
  TrackedOperator bodies;
  bodies[role].state = BodyState::kTracked;
  for (int i = 0; i < 120; ++i) {
    bodies[role].pose.position_m = {0.4, 0.0, i < 60 ? -0.9 : -0.9 + by_z_m};
    figure.update(i * test::kMotionFrame_s, test::tool_at(0.0), bodies);
  }
  return figure.pose();
}

TEST(FigureWords, SayWhichAnkleItsLegCannotReach) {
  const FigurePose left = with_ankle(BodyRole::kLeftAnkle, -0.10);
  EXPECT_EQ(left.words, "the leg cannot reach the left ankle");
  EXPECT_EQ(left.trouble, FigureTrouble::kOutOfReach);
  EXPECT_EQ(left.leg_reached, (std::array{false, true}));
  const FigurePose right = with_ankle(BodyRole::kRightAnkle, -0.10);
  EXPECT_EQ(right.words, "the leg cannot reach the right ankle");
  EXPECT_EQ(right.leg_reached, (std::array{true, false}));
  EXPECT_EQ(with_ankle(BodyRole::kLeftAnkle, 0.10).words, "") << "a bent knee reaches";
}

TEST(FigureWords, UnreachedAnkleWithoutATrackerIsNotReported) {
  // On tiptoe: the hips rise beyond what the untracked feet would allow.
  Figure figure;
  TrackedOperator bodies;
  bodies[BodyRole::kWaist].state = BodyState::kTracked;
  for (int i = 0; i < 120; ++i) {
    bodies[BodyRole::kWaist].pose.position_m = {0.4, 0.0, i < 60 ? 0.0 : 0.10};
    figure.update(i * test::kMotionFrame_s, test::tool_at(0.0), bodies);
  }
  const Vector3d standing_m = standing_ankle_m(figure.plan(), true);
  EXPECT_GT((figure.pose()[FigureJoint::kRightAnkle] - standing_m).norm(), kLimbTolerance_m);
  EXPECT_EQ(figure.pose().words, "");
}

TEST(FigureWords, SayThatTheArmCannotReachTheLeftHand) {
  const auto after = [](double by_x_m) {
    Figure figure;
    TrackedOperator bodies;
    bodies[BodyRole::kLeftHand].state = BodyState::kTracked;
    for (int i = 0; i < 120; ++i) {
      bodies[BodyRole::kLeftHand].pose.position_m = {i < 60 ? 0.1 : 0.1 + by_x_m, -0.3, 0.0};
      figure.update(i * test::kMotionFrame_s, test::tool_at(0.0), bodies);
    }
    return figure.pose();
  };
  const FigurePose far = after(-0.30);
  EXPECT_EQ(far.words, "the arm cannot reach the left hand");
  EXPECT_EQ(far.trouble, FigureTrouble::kOutOfReach);
  EXPECT_FALSE(far.left_hand_reached);
  EXPECT_EQ(after(-0.05).words, "") << "a bent elbow reaches";
}

TEST(FigureWords, WorstProblemIsReportedFirst) {
  TrackedOperator bodies;
  bodies[BodyRole::kHead] = {.state = BodyState::kLost, .trouble = TrackingTrouble::kSilent};
  FigurePose pose;
  pose.arm.reached = true;
  report(bodies, pose);
  EXPECT_EQ(pose.words, "head lost (silent)");
  pose.leg_reached[1] = false;
  report(bodies, pose);
  EXPECT_EQ(pose.words, "the leg cannot reach the right ankle");
  pose.arm.reached = false;
  report(bodies, pose);
  EXPECT_EQ(pose.words, "the arm cannot reach the tool");
  pose.arm.reached = pose.leg_reached[1] = true;
  report({}, pose);
  EXPECT_EQ(pose.words, "");
  EXPECT_EQ(pose.trouble, FigureTrouble::kNone);
}

}  // namespace tact::host::figure::figure_words_test
