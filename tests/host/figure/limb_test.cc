// SPDX-License-Identifier: Apache-2.0
#include "host/figure/limb.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tact::host::figure::limb_test {

using Eigen::Vector3d;
constexpr LimbBones kLeg{.upper_m = 0.42, .lower_m = 0.38};
const Vector3d kForward = Vector3d::UnitX(), kLeft = Vector3d::UnitY(), kUp = Vector3d::UnitZ();

TEST(Limb, MatchesPenAndPaper) {
  // Sides 3, 4, 5: right angle at the knee; the knee's foot on the hypotenuse is at 9/5, 12/5 high.
  const Limb at =
      pose_limb({.upper_m = 3.0, .lower_m = 4.0}, Vector3d::Zero(), 5.0 * kForward, kUp, kLeft);
  EXPECT_LT((at.middle_m - Vector3d(1.8, 0.0, 2.4)).norm(), 1e-15);
  EXPECT_EQ(at.end_m, Vector3d(5.0, 0.0, 0.0));
  EXPECT_EQ(at.missed_m, 0.0);
}

TEST(Limb, KeepsBoneLengthsAndBendsToTheSideOfTheHint) {
  const Vector3d hip(0.1, 0.2, 0.9);
  for (double d = 0.02; d < 1.0; d += 0.07) {  // from too near to too far
    for (double angle = -3.1; angle < 3.1; angle += 0.4) {
      const Vector3d along(std::cos(angle), 0.3, std::sin(angle));
      const Limb at = pose_limb(kLeg, hip, hip + d * along.normalized(), kForward, kUp);
      EXPECT_EQ(at.missed_m < 1e-12, d > 0.04 && d < 0.8);
      EXPECT_NEAR((at.middle_m - hip).norm(), 0.42, 1e-14);
      EXPECT_NEAR((at.end_m - at.middle_m).norm(), 0.38, 1e-14);
      const Vector3d side = across(kForward, along.normalized(), kUp);
      EXPECT_GE((at.middle_m - hip).dot(side), -1e-14);
    }
  }
}

TEST(Limb, OutOfReachItStretchesOrFoldsTowardsItsEnd) {
  const Vector3d hip(0.0, 0.0, 1.0);
  const Limb far = pose_limb(kLeg, hip, {0.0, 0.0, -5.0}, kForward, kLeft);
  EXPECT_LT((far.middle_m - Vector3d(0.0, 0.0, 0.58)).norm(), 1e-15) << "straight";
  EXPECT_LT((far.end_m - Vector3d(0.0, 0.0, 0.2)).norm(), 1e-15);
  EXPECT_NEAR(far.missed_m, 5.2, 1e-15);
  const Limb near = pose_limb(kLeg, hip, {0.0, 0.0, 0.99}, kForward, kLeft);
  EXPECT_LT((near.middle_m - Vector3d(0.0, 0.0, 0.58)).norm(), 1e-15) << "folded";
  EXPECT_LT((near.end_m - Vector3d(0.0, 0.0, 0.96)).norm(), 1e-15);
  EXPECT_NEAR(near.missed_m, 0.03, 1e-15);
}

TEST(Limb, KeepsItsDigitsNearFullStretchWhereAnAcosLosesHalf) {
  // L1 = L2 = L and D = 2 L (1 - s): the knee is L sqrt(2 s) beside the ray for small s. The law of
  // cosines through acos has an error of sqrt(1e-16) = 1e-8 there, a tenth of the angle.
  const double length_m = 0.41, share = 5e-15;
  const double d = 2.0 * length_m * (1.0 - share);
  const double real_share = (2.0 * length_m - d) / (2.0 * length_m);  // after rounding
  const Limb at = pose_limb({.upper_m = length_m, .lower_m = length_m}, Vector3d::Zero(),
                            d * kForward, kUp, kLeft);
  EXPECT_NEAR(at.middle_m.z() / (length_m * std::sqrt(2.0 * real_share)), 1.0, 1e-9);
}

TEST(Limb, AFoldedLimbHasAPose) {
  const Vector3d hip(0.2, 0.0, 1.0);
  const Limb at = pose_limb({.upper_m = 0.4, .lower_m = 0.4}, hip, hip, kForward, kLeft);
  EXPECT_LT((at.middle_m - Vector3d(0.6, 0.0, 1.0)).norm(), 1e-15);
  EXPECT_EQ(at.end_m, hip);
}

TEST(Limb, ANumberTooLargeStretchesItAndNanLeavesItAtItsRoot) {
  const Vector3d hip(0.0, 0.0, 1.0);
  EXPECT_TRUE(pose_limb(kLeg, hip, {1e150, 0.0, -1e150}, kForward, kLeft).middle_m.allFinite());
  const Limb none = pose_limb(kLeg, hip, {std::nan(""), 0.0, 0.0}, kForward, kLeft);
  EXPECT_EQ(none.middle_m, hip);
  EXPECT_EQ(none.end_m, hip);
  EXPECT_TRUE(std::isnan(none.missed_m));
}

}  // namespace tact::host::figure::limb_test
