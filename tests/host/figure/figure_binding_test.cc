// SPDX-License-Identifier: Apache-2.0
// Which joint follows which tracker, and what stays: one body is bound, then moved and turned, and
// the figure is compared with one whose body stays where it was.
#include <gtest/gtest.h>

#include "host/figure/figure.h"
#include "tests/support/operator_motion.h"

namespace tact::host::figure::figure_binding_test {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using enum FigureJoint;

constexpr std::array kLeftLeg{kLeftHip, kLeftKnee, kLeftAnkle, kLeftToes};
constexpr std::array kRightLeg{kRightHip, kRightKnee, kRightAnkle, kRightToes};
constexpr std::array kLeftArm{kLeftShoulder, kLeftElbow, kLeftWrist, kLeftKnuckles, kLeftFingers};
constexpr std::array kRightArm{kRightShoulder, kRightElbow, kRightWrist, kRightKnuckles,
                               kRightFingers};

/// The figure whose body stays, the one whose body moved, and the motion of the body in W.
struct Compared {
  FigurePose stays, moved;
  Isometry3d motion;
};

/// The body sits beside its bone and is turned against it: only a binding brings the two together.
Compared compare(BodyRole role, const Vector3d& home_m, const Vector3d& by_m, double turn_rad,
                 const Vector3d& axis) {
  const AngleAxisd mounted(0.7, Vector3d(2.0, -1.0, 1.0).normalized());
  const Isometry3d home(Eigen::Translation3d(home_m) * mounted);
  const Isometry3d away(Eigen::Translation3d(home_m + by_m) *
                        AngleAxisd(turn_rad, axis.normalized()) * mounted);
  const auto run = [&](const Isometry3d& to) {
    Figure figure;
    TrackedOperator bodies;
    bodies[role].state = BodyState::kTracked;
    for (int i = 0; i < 240; ++i) {  // two seconds to bind, two to follow
      const Isometry3d& now = i < 120 ? home : to;
      bodies[role].pose = {.rotation = Eigen::Quaterniond(now.rotation()),
                           .position_m = now.translation()};
      figure.update(i * test::kMotionFrame_s, test::tool_at(0.0), bodies);
    }
    return figure.pose();
  };
  return {.stays = run(home), .moved = run(away), .motion = away * home.inverse()};
}

template <typename Joints>
void expect_followed(const Compared& figures, const Joints& joints) {
  for (const FigureJoint joint : joints) {
    const Vector3d wanted_m = figures.motion * figures.stays[joint];
    EXPECT_LT((figures.moved[joint] - wanted_m).norm(), 1e-9)
        << kFigureJointNames[static_cast<std::size_t>(joint)];
    EXPECT_GT((figures.stays[joint] - wanted_m).norm(), 0.01) << "nothing was asked of it";
  }
}

template <typename Joints>
void expect_stayed(const Compared& figures, const Joints& joints) {
  for (const FigureJoint joint : joints) {
    EXPECT_LT((figures.moved[joint] - figures.stays[joint]).norm(), 1e-12)
        << kFigureJointNames[static_cast<std::size_t>(joint)];
  }
}

/// Bit 0: translation, bit 1: rotation.
class Binding : public testing::TestWithParam<std::tuple<bool, int>> {
 protected:
  bool right() const { return std::get<0>(GetParam()); }
  double side() const { return right() ? 1.0 : -1.0; }
  Vector3d by_m(const Vector3d& by_m) const {
    return (std::get<1>(GetParam()) & 1) != 0 ? by_m : Vector3d::Zero();
  }
  double turn_rad(double turn_rad) const {
    return (std::get<1>(GetParam()) & 2) != 0 ? turn_rad : 0.0;
  }
};

TEST_P(Binding, ThePelvisGoesWithTheWaistAndTheFeetStay) {
  const Compared figures =
      compare(BodyRole::kWaist, {0.55, -0.03 + 0.1 * side(), -0.10},
              by_m({-0.04, 0.06 * side(), -0.05}), turn_rad(0.3 * side()), {0.1, 0.2, 1.0});
  expect_followed(figures, std::array{kPelvis, kLeftHip, kRightHip});
  expect_stayed(figures, std::array{kLeftAnkle, kRightAnkle});
}

TEST_P(Binding, AFootGoesWithItsAnkleAndTheOtherLegStays) {
  const BodyRole role = right() ? BodyRole::kRightAnkle : BodyRole::kLeftAnkle;
  const Compared figures =
      compare(role, {0.50, -0.09 + 0.16 * side(), -0.90}, by_m({-0.10, 0.06 * side(), 0.12}),
              turn_rad(0.4 * side()), {0.2, -0.3, 1.0});
  if (right())
    expect_followed(figures, std::array{kRightAnkle, kRightToes});
  else
    expect_followed(figures, std::array{kLeftAnkle, kLeftToes});
  expect_stayed(figures, right() ? kLeftLeg : kRightLeg);
}

TEST_P(Binding, AKneeGoesToTheSideWhereItsLegIsAndNothingElseMoves) {
  const BodyRole role = right() ? BodyRole::kRightLeg : BodyRole::kLeftLeg;
  const Compared figures =
      compare(role, {0.30, -0.09 + 0.2 * side(), -0.50}, by_m({0.0, 0.10 * side(), 0.0}),
              turn_rad(0.9 * side()), {0.1, 0.1, 1.0});
  const auto& leg = right() ? kRightLeg : kLeftLeg;
  const Vector3d hip_m = figures.stays[leg[0]], ankle_m = figures.stays[leg[2]];
  const auto across = [&](const Vector3d& p_m) -> Vector3d {
    const Vector3d along = (ankle_m - hip_m).normalized();
    return ((p_m - hip_m) - (p_m - hip_m).dot(along) * along).normalized();
  };
  // What is bound is the hint, which is in front of the leg.
  const Vector3d hint_m = 0.5 * (hip_m + ankle_m) - 0.1 * Vector3d::UnitX();
  EXPECT_LT((across(figures.stays[leg[1]]) - across(hint_m)).norm(), 1e-9);
  const Vector3d wanted = across(figures.motion * hint_m);
  EXPECT_LT((across(figures.moved[leg[1]]) - wanted).norm(), 1e-9);
  EXPECT_GT((across(hint_m) - wanted).norm(), 0.2) << "nothing was asked of it";
  expect_stayed(figures, std::array{leg[0], leg[2], leg[3]});
  expect_stayed(figures, right() ? kLeftLeg : kRightLeg);
}

INSTANTIATE_TEST_SUITE_P(Sides, Binding,
                         testing::Combine(testing::Bool(), testing::Values(1, 2, 3)));

TEST(LeftHand, WristAndHandGoWithItsTrackerAndNothingElseMoves) {
  for (const double turn_rad : {0.0, 0.4}) {
    const Compared figures = compare(BodyRole::kLeftHand, {0.10, -0.35, 0.05}, {-0.04, -0.08, 0.12},
                                     turn_rad, {1, 2, 3});
    expect_followed(figures, std::array{kLeftWrist, kLeftKnuckles, kLeftFingers});
    expect_stayed(figures, kRightArm);
    expect_stayed(figures, kLeftLeg);
    expect_stayed(figures, std::array{kLeftShoulder, kHead, kPelvis});
  }
}

TEST(LeftHand, IsBoundWhereItRestsAndTheElbowStaysThere) {
  Figure untracked;
  const Compared figures =
      compare(BodyRole::kLeftHand, {0.10, -0.35, 0.05}, Vector3d::Zero(), 0.0, {1, 0, 0});
  for (const FigureJoint joint : kLeftArm)
    EXPECT_LT((figures.stays[joint] - untracked.pose()[joint]).norm(), 1e-9);
}

TEST(LeftHand, TheElbowIsBelowTheArmOrBesideItAndNeverInside) {
  for (const Vector3d& by_m : {Vector3d(0.0, 0.0, 0.35), Vector3d(0.15, 0.30, 0.25),
                               Vector3d(0.20, -0.15, 0.0), Vector3d(0.25, -0.1, -0.15)}) {
    const Compared figures = compare(BodyRole::kLeftHand, {0.10, -0.30, 0.0}, by_m, 0.0, {1, 0, 0});
    const Vector3d shoulder_m = figures.moved[kLeftShoulder], wrist_m = figures.moved[kLeftWrist];
    const Vector3d along = (wrist_m - shoulder_m).normalized();
    const Vector3d elbow_m = figures.moved[kLeftElbow] - shoulder_m;
    const Vector3d beside_m = elbow_m - elbow_m.dot(along) * along;
    EXPECT_GT(beside_m.norm(), 0.05) << "the arm is bent";
    EXPECT_TRUE(beside_m.z() < -0.02 || beside_m.y() < -0.02) << beside_m.transpose();
    EXPECT_LT(beside_m.y(), 0.01);
  }
}

TEST(LeftHand, GoesBackToRestWhenItIsLost) {
  Figure figure;
  const FigurePose rest = figure.pose();
  TrackedOperator bodies;
  TrackedBody& hand = bodies[BodyRole::kLeftHand];
  double t_s = 0.0;
  const auto run_s = [&](double duration_s, BodyState state, double z_m) {
    hand.state = state;
    hand.pose.position_m = {0.1, -0.3, z_m};
    for (const double end_s = t_s + duration_s; t_s < end_s; t_s += test::kMotionFrame_s)
      figure.update(t_s, test::tool_at(0.0), bodies);
    return (figure.pose()[kLeftWrist] - rest[kLeftWrist]).norm();
  };
  run_s(2.0, BodyState::kTracked, 0.0);
  EXPECT_NEAR(run_s(2.0, BodyState::kTracked, 0.1), 0.1, 1e-9);
  EXPECT_NEAR(run_s(0.4, BodyState::kHeld, 5.0), 0.1, 1e-9);
  EXPECT_EQ(figure.pose().words, "left hand held (no pose)");
  EXPECT_LT(run_s(1.2, BodyState::kLost, 5.0), 1e-9);
}

class ElbowBinding : public testing::Test {
 protected:
  static Compared compared(const Vector3d& by_m) {
    return compare(BodyRole::kElbow, {0.45, 0.30, 0.05}, by_m, 0.3, {0, 0, 1});
  }
  /// Angle about the line from shoulder to wrist, from one figure's elbow to the other's, rad.
  static double swivel_rad(const FigurePose& from, const Vector3d& to_m) {
    const Vector3d axis = (from[kRightWrist] - from[kRightShoulder]).normalized();
    const auto beside = [&](const Vector3d& p_m) -> Vector3d {
      const Vector3d from_m = p_m - from[kRightShoulder];
      return from_m - from_m.dot(axis) * axis;
    };
    const Vector3d a = beside(from[kRightElbow]), b = beside(to_m);
    return std::atan2(axis.dot(a.cross(b)), a.dot(b));
  }
};

TEST_F(ElbowBinding, TheElbowGoesToTheSideWhereItsTrackerIsAndTheHandStays) {
  for (const Vector3d& by_m : {Vector3d(0.0, 0.06, 0.05), Vector3d(0.0, -0.02, 0.0)}) {
    const Compared figures = compared(by_m);
    // What is bound is the elbow of the frame before.
    const Vector3d wanted_m = figures.motion * Figure().pose()[kRightElbow];
    const double wanted_rad = swivel_rad(figures.stays, wanted_m);
    EXPECT_GT(std::abs(wanted_rad), 0.05) << "nothing was asked of it";
    EXPECT_NEAR(swivel_rad(figures.stays, figures.moved[kRightElbow]), wanted_rad, 1e-6);
    expect_stayed(figures, std::array{kChest, kRightShoulder});
    for (const FigureJoint joint : {kRightWrist, kRightKnuckles, kRightFingers})
      EXPECT_LT((figures.moved[joint] - figures.stays[joint]).norm(), 1e-6);
    expect_stayed(figures, kLeftArm);
  }
}

class HandBinding : public testing::TestWithParam<BodyRole> {};

TEST_P(HandBinding, ThePalmTurnsWithItsTrackerAndTheFingersStayAtTheTool) {
  for (const Vector3d& axis : {Vector3d(Vector3d::UnitX()), Vector3d(0.2, 1.0, 0.3)}) {
    const Compared figures =
        compare(GetParam(), {0.20, 0.10, 0.15}, {0.03, 0.02, -0.04}, 0.25, axis);
    const auto palm = [](const FigurePose& pose) -> Vector3d {
      return (pose[kRightKnuckles] - pose[kRightWrist]).normalized();
    };
    EXPECT_LT((palm(figures.moved) - figures.motion.rotation() * palm(figures.stays)).norm(), 1e-6);
    EXPECT_GT((palm(figures.moved) - palm(figures.stays)).norm(), 0.1);
    EXPECT_LT((figures.moved[kRightFingers] - figures.moved.grip_m).norm(), kGripTolerance_m);
    EXPECT_EQ(figures.moved.grip_m, figures.stays.grip_m) << "the tool alone says where";
    expect_stayed(figures, kLeftArm);
    expect_stayed(figures, kLeftLeg);
    expect_stayed(figures, kRightLeg);
  }
}

INSTANTIATE_TEST_SUITE_P(Trackers, HandBinding, testing::Values(BodyRole::kWrist, BodyRole::kHand));

TEST(WristAndHand, TheHandSaysHowThePalmIsTurned) {
  const auto after = [](double wrist_rad, double hand_rad) {
    Figure figure;
    TrackedOperator bodies;
    for (int i = 0; i < 240; ++i) {
      const auto turned = [&](double turn_rad) {
        TrackedBody body{.state = BodyState::kTracked};
        body.pose.rotation = AngleAxisd(i < 120 ? 0.0 : turn_rad, Vector3d::UnitX());
        return body;
      };
      bodies[BodyRole::kWrist] = turned(wrist_rad);
      bodies[BodyRole::kHand] = turned(hand_rad);
      figure.update(i * test::kMotionFrame_s, test::tool_at(0.0), bodies);
    }
    return figure.pose()[kRightKnuckles];
  };
  EXPECT_LT((after(0.3, 0.0) - after(0.0, 0.0)).norm(), 1e-12);
  EXPECT_GT((after(0.0, 0.3) - after(0.0, 0.0)).norm(), 0.01);
}

}  // namespace tact::host::figure::figure_binding_test
