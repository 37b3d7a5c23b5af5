// SPDX-License-Identifier: Apache-2.0
#include "host/figure/bound_bone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tact::host::figure::bound_bone_test {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 60.0;

Pose pose(double x_m, double turn_rad = 0.0) {
  return {.rotation = Quaterniond(AngleAxisd(turn_rad, Vector3d(1, 2, 2) / 3.0)),
          .position_m = {x_m, 0.2, 0.3}};
}
TrackedBody body(BodyState state, const Pose& at = {}) { return {.state = state, .pose = at}; }

double apart_m(const Pose& a, const Pose& b) { return (a.position_m - b.position_m).norm(); }

/// Follows the same input for a while and gives the longest way of one frame.
double follow_for_s(BoundBone& bone, const TrackedBody& input, const Pose& neutral,
                    double duration_s) {
  double most_m = 0.0;
  for (double t_s = 0.0; t_s < duration_s; t_s += kFrame_s) {
    const Pose before = bone.now();
    most_m = std::max(most_m, apart_m(before, bone.follow(input, neutral, kFrame_s)));
  }
  return most_m;
}

/// Bound at x = 1 m to the neutral bone at 0, then moved to x = 1.2 m.
BoundBone driven_to_20_cm(const Pose& neutral) {
  BoundBone bone;
  bone.follow(body(BodyState::kTracked, pose(1.0)), neutral, kFrame_s);
  follow_for_s(bone, body(BodyState::kTracked, pose(1.2)), neutral, 0.5);
  return bone;
}

TEST(BoundBone, StaysWhereItIsInTheBindingFrameAndFollowsFromThere) {
  const Pose neutral = pose(0.0, 0.4);
  BoundBone bone;
  const Pose first = bone.follow(body(BodyState::kTracked, pose(1.0, 1.1)), neutral, kFrame_s);
  EXPECT_LT(apart_m(first, neutral), 1e-12);
  EXPECT_LT(first.rotation.angularDistance(neutral.rotation), 1e-7);
  follow_for_s(bone, body(BodyState::kTracked, pose(1.2, 1.1)), neutral, 0.5);
  EXPECT_NEAR(bone.now().position_m.x(), 0.2, 1e-12) << "20 cm to the side, as the tracker";
  EXPECT_LT(bone.now().rotation.angularDistance(neutral.rotation), 1e-7);
}

TEST(BoundBone, HoldsWhileTheTrackerIsHeld) {
  const Pose neutral = pose(0.0);
  BoundBone bone = driven_to_20_cm(neutral);
  EXPECT_EQ(follow_for_s(bone, body(BodyState::kHeld, pose(9.0)), neutral, 2.0), 0.0);
  EXPECT_NEAR(bone.now().position_m.x(), 0.2, 1e-12);
}

TEST(BoundBone, FadesToTheNeutralPoseInASecondWhenLost) {
  const Pose neutral = pose(0.0);
  BoundBone bone = driven_to_20_cm(neutral);
  follow_for_s(bone, body(BodyState::kLost), neutral, 0.5);
  EXPECT_NEAR(bone.now().position_m.x(), 0.1, 0.005) << "half of the way in half of the time";
  EXPECT_NEAR(bone.share(), 0.5, 0.03);
  follow_for_s(bone, body(BodyState::kLost), neutral, 0.55);
  EXPECT_LT(apart_m(bone.now(), neutral), 1e-12);
  EXPECT_EQ(bone.share(), 0.0);
}

TEST(BoundBone, ComesBackInThirtyHundredthsOfASecondWithoutAJump) {
  const Pose neutral = pose(0.0);
  BoundBone bone = driven_to_20_cm(neutral);
  follow_for_s(bone, body(BodyState::kLost), neutral, 1.2);
  const double step_m =
      follow_for_s(bone, body(BodyState::kTracked, pose(1.2)), neutral, kReturn_s - 0.02);
  EXPECT_LT(step_m, 0.02) << "1.5 of the mean step of 0.2 m in 18 frames";
  EXPECT_LT(bone.now().position_m.x(), 0.2);
  follow_for_s(bone, body(BodyState::kTracked, pose(1.2)), neutral, 0.05);
  EXPECT_NEAR(bone.now().position_m.x(), 0.2, 1e-12) << "the binding of the first time is kept";
}

TEST(BoundBone, GlidesWhereTheTrackerJumps) {
  const Pose neutral = pose(0.0);
  BoundBone bone = driven_to_20_cm(neutral);
  const double step_m = follow_for_s(bone, body(BodyState::kTracked, pose(2.2)), neutral, 1.0);
  EXPECT_LT(step_m / kFrame_s, 1.6 * kGlide_mps);
  EXPECT_NEAR(bone.now().position_m.x(), 1.2, 1e-12);
}

TEST(BoundBone, FollowsAFastHandWithoutLag) {
  BoundBone bone;
  double lag_m = 0.0;
  for (int i = 0; i < 120; ++i) {
    const double x_m = 0.25 * std::sin(8.0 * i * kFrame_s);  // 2 m/s at most
    bone.follow(body(BodyState::kTracked, pose(x_m)), pose(0.0), kFrame_s);
    if (i > 30) lag_m = std::max(lag_m, std::abs(bone.now().position_m.x() - x_m));
  }
  EXPECT_LT(lag_m, 1e-12);
}

TEST(BoundBone, TakesAPoseThatIsNotFiniteForHeld) {
  const Pose neutral = pose(0.0);
  BoundBone bone = driven_to_20_cm(neutral);
  const double none = std::numeric_limits<double>::quiet_NaN();
  Pose turned = pose(1.0);
  turned.rotation.coeffs()[0] = none;
  Pose zero = pose(1.0);
  zero.rotation.coeffs().setZero();
  for (const Pose& bad : {pose(none), turned, zero, pose(1.0 / 0.0)}) {
    EXPECT_EQ(follow_for_s(bone, body(BodyState::kTracked, bad), neutral, 0.2), 0.0);
    EXPECT_NEAR(bone.now().position_m.x(), 0.2, 1e-12);
  }
  BoundBone fresh;
  EXPECT_LT(
      apart_m(fresh.follow(body(BodyState::kTracked, pose(none)), neutral, kFrame_s), neutral),
      1e-12);
  EXPECT_FALSE(fresh.offset().has_value()) << "it binds to a good pose only";
}

}  // namespace tact::host::figure::bound_bone_test
