// SPDX-License-Identifier: Apache-2.0
#include "host/figure/leg_ik.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace tact::host::figure::leg_ik_test {

using Eigen::Vector2d;
using std::numbers::pi;
constexpr Leg kLeg{.thigh_m = 0.42, .calf_m = 0.38};

Vector2d polar(double length_m, double angle_rad) {
  return length_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

TEST(LegIk, MatchesPenAndPaper) {
  // Sides 3, 4, 5: right angle at the knee; the knee's foot on the hypotenuse is at 9/5, 12/5 high.
  const LegPose at = pose_leg({.thigh_m = 3.0, .calf_m = 4.0}, {0.0, 0.0}, {5.0, 0.0});
  EXPECT_EQ(at.status, LegStatus::kOk);
  EXPECT_NEAR(at.interior_knee_rad, pi / 2.0, 1e-15);
  EXPECT_NEAR(at.interior_hip_rad, std::atan2(4.0, 3.0), 1e-15);
  EXPECT_NEAR(at.interior_ankle_rad, std::atan2(3.0, 4.0), 1e-15);
  EXPECT_LT((at.knee_m - Vector2d(1.8, 2.4)).norm(), 1e-15);
}

TEST(LegIk, KeepsBoneLengthsAndTheTriangle) {
  const Vector2d hip(0.1, 0.9);
  for (const Bend bend : {Bend::kCounterClockwise, Bend::kClockwise}) {
    for (double d = 0.02; d < 1.0; d += 0.07) {  // from too near to too far
      for (double angle = -3.1; angle < 3.1; angle += 0.4) {
        const Leg leg{.thigh_m = 0.42, .calf_m = 0.38, .bend = bend};
        const LegPose at = pose_leg(leg, hip, hip + polar(d, angle));
        EXPECT_EQ(at.status == LegStatus::kOk, d > 0.04 && d < 0.8);
        EXPECT_NEAR((at.knee_m - hip).norm(), 0.42, 1e-14);
        EXPECT_NEAR((at.ankle_m - at.knee_m).norm(), 0.38, 1e-14);
        EXPECT_NEAR(at.interior_hip_rad + at.interior_knee_rad + at.interior_ankle_rad, pi, 1e-14);
        // The bones point where the angles say.
        EXPECT_LT((hip + polar(0.42, at.thigh_angle_rad) - at.knee_m).norm(), 1e-14);
        EXPECT_LT((at.knee_m + polar(0.38, at.shank_angle_rad) - at.ankle_m).norm(), 1e-14);
      }
    }
  }
}

TEST(LegIk, TheKneeIsOnTheSideThatWasAskedFor) {
  const Vector2d hip(0.0, 1.0), ankle(0.3, 0.4), ray = ankle - hip;
  for (const Bend bend : {Bend::kCounterClockwise, Bend::kClockwise}) {
    const LegPose at = pose_leg({.thigh_m = 0.42, .calf_m = 0.38, .bend = bend}, hip, ankle);
    const Vector2d knee = at.knee_m - hip;
    const double side = ray.x() * knee.y() - ray.y() * knee.x();
    EXPECT_GT(side * (bend == Bend::kCounterClockwise ? 1.0 : -1.0), 0.01);
  }
}

TEST(LegIk, OutOfReachItStretchesOrFoldsTowardsTheAnkle) {
  const LegPose far = pose_leg(kLeg, {0.0, 1.0}, {0.0, -5.0});
  EXPECT_EQ(far.status, LegStatus::kUnreachable);
  EXPECT_EQ(far.flexion_knee_rad, 0.0);
  EXPECT_LT((far.ankle_m - Vector2d(0.0, 0.2)).norm(), 1e-15);
  const LegPose near = pose_leg(kLeg, {0.0, 1.0}, {0.0, 0.99});
  EXPECT_EQ(near.status, LegStatus::kUnreachable);
  EXPECT_EQ(near.interior_knee_rad, 0.0);
  EXPECT_LT((near.ankle_m - Vector2d(0.0, 0.96)).norm(), 1e-15);
}

TEST(LegIk, KeepsItsDigitsNearFullStretchWhereAnAcosLosesHalf) {
  // L1 = L2 = L and D = 2 L (1 - s): interior_hip = acos(1 - s) = sqrt(2 s) for small s. The law of
  // cosines through acos has an error of sqrt(1e-16) = 1e-8 there, a tenth of the angle.
  const double length_m = 0.41, share = 5e-15;
  const double d = 2.0 * length_m * (1.0 - share);
  const double real_share = (2.0 * length_m - d) / (2.0 * length_m);  // after rounding
  const LegPose at = pose_leg({.thigh_m = length_m, .calf_m = length_m}, {0.0, 0.0}, {d, 0.0});
  EXPECT_NEAR(at.interior_hip_rad / std::sqrt(2.0 * real_share), 1.0, 1e-9);
  EXPECT_NEAR(at.flexion_knee_rad / (2.0 * std::sqrt(2.0 * real_share)), 1.0, 1e-7);
}

TEST(LegIk, AFoldedLegHasAPose) {
  const LegPose at = pose_leg({.thigh_m = 0.4, .calf_m = 0.4}, {0.2, 1.0}, {0.2, 1.0});
  EXPECT_EQ(at.status, LegStatus::kOk);
  EXPECT_EQ(at.interior_hip_rad, pi / 2.0);
  EXPECT_EQ(at.interior_ankle_rad, pi / 2.0);
  EXPECT_LT((at.knee_m - Vector2d(0.2, 1.4)).norm(), 1e-15);
  EXPECT_EQ(at.ankle_m, Vector2d(0.2, 1.0));
}

TEST(LegIk, RefusesWhatHasNoMeaning) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const Vector2d hip(0.0, 1.0), ankle(0.0, 0.4);
  for (const double bad : {nan, inf, 0.0, -0.4}) {
    EXPECT_EQ(pose_leg({.thigh_m = bad, .calf_m = 0.4}, hip, ankle).status, LegStatus::kInvalid);
    EXPECT_EQ(pose_leg({.thigh_m = 0.4, .calf_m = bad}, hip, ankle).status, LegStatus::kInvalid);
  }
  EXPECT_EQ(pose_leg(kLeg, {0.0, nan}, ankle).status, LegStatus::kInvalid);
  EXPECT_EQ(pose_leg(kLeg, hip, {inf, 0.0}).status, LegStatus::kInvalid);
  EXPECT_TRUE(pose_leg(kLeg, hip, {1e300, -1e300}).knee_m.allFinite());
}

}  // namespace tact::host::figure::leg_ik_test
