// SPDX-License-Identifier: Apache-2.0
#include "host/figure/body_plan.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace tact::host::figure::body_plan_test {

TEST(BodyPlan, MatchesWintersRatiosForOnePersonOf175Centimetres) {
  const BodyPlan plan = make_body_plan(1.75);
  EXPECT_NEAR(plan.upper_arm_m, 0.3255, 1e-9);              // 0.186 * 1.75
  EXPECT_NEAR(plan.forearm_m, 0.2555, 1e-9);                // 0.146 * 1.75
  EXPECT_NEAR(plan.thigh_m, 0.42875, 1e-9);                 // (0.530 - 0.285) * 1.75
  EXPECT_NEAR(plan.calf_m, 0.4305, 1e-9);                   // (0.285 - 0.039) * 1.75
  EXPECT_NEAR(2.0 * plan.clavicle_m, 0.4515, 1e-9);         // shoulder to shoulder
  EXPECT_NEAR(plan.lumbar_m + plan.thorax_m, 0.504, 1e-9);  // (0.818 - 0.530) * 1.75
}

TEST(BodyPlan, EveryLengthGrowsWithTheHeightAndKeepsItsBounds) {
  const BodyPlan small = make_body_plan(1.4), tall = make_body_plan(2.0);
  EXPECT_NEAR(tall.forearm_m / small.forearm_m, 2.0 / 1.4, 1e-12);
  EXPECT_EQ(make_body_plan(9.0).height_m, 2.2);
  EXPECT_EQ(make_body_plan(-1.0).height_m, 1.2);
  EXPECT_EQ(make_body_plan(std::numeric_limits<double>::quiet_NaN()).height_m, 1.75);
}

TEST(BodyPlan, ItsCrownIsAsHighAsThePersonAndItsFeetAreOnTheFloor) {
  // Straight legs below the hips, the head's radius above its joint: 1.75 m from floor to crown.
  const BodyPlan plan = make_body_plan(1.75);
  const auto parts = capsules(plan);
  double top_m = 0.0;
  for (const Capsule& part : parts)
    if (part.b == FigureJoint::kCrown) top_m = part.radius_b_m;
  top_m += upright_m(plan, FigureJoint::kHead).z() + plan.head_m;
  const double ankle_m = 0.039 * 1.75;
  EXPECT_NEAR(top_m + plan.thigh_m + plan.calf_m + ankle_m, 1.75, 1e-9);
}

TEST(BodyPlan, TheArmHasSevenJointsWhoseRestIsWithinTheirLimits) {
  const Chain chain = arm_chain(make_body_plan(1.75));
  const auto rest = arm_at_rest();
  ASSERT_EQ(chain.bones.size(), 7u);
  EXPECT_FALSE(joint_points_m(chain, rest).empty()) << "ccd takes it as a start";
  EXPECT_GE(chain.bones[4].lo_rad, 0.05) << "a straight arm would not move";
}

TEST(BodyPlan, CapsulesJoinDifferentJointsAndTheToolsArmIsMarked) {
  std::set<FigureJoint> held;
  for (const Capsule& part : capsules(make_body_plan(1.75))) {
    EXPECT_NE(part.a, part.b);
    EXPECT_GT(part.radius_a_m, 0.005);
    EXPECT_LT(part.radius_a_m, 0.2);
    if (part.holds_tool) held.insert(part.b);
  }
  using enum FigureJoint;
  EXPECT_EQ(held, (std::set{kRightElbow, kRightWrist, kRightKnuckles, kRightFingers}));
}

}  // namespace tact::host::figure::body_plan_test
