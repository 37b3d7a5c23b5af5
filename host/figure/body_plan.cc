// SPDX-License-Identifier: Apache-2.0
#include "host/figure/body_plan.h"

#include <algorithm>
#include <cmath>

namespace tact::host::figure {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Shares of the body height; Winter's are marked W.
constexpr double kAnkle = 0.039, kKnee = 0.285, kHip = 0.530, kShoulder = 0.818;  // W, heights
constexpr double kChin = 0.870;                                                   // W, height
// Chosen (body_plan.h): where the back bends; the origin of W is about a bench above the floor.
constexpr double kBackHeight = 0.630, kOriginHeight = 0.600;
constexpr double kHeadRadius = 0.044;

// Chosen, so that the right hand reaches the device and the face looks at the tool.
constexpr double kPelvisAt_m = 0.40;  // x of the pelvis, for 1.75 m
constexpr double kLooksDown_rad = 0.75;

}  // namespace

BodyPlan make_body_plan(double height_m) {
  // An invalid height gives a common one, so that the figure has a size.
  const double h = std::clamp(std::isfinite(height_m) ? height_m : 1.75, 1.2, 2.2);
  return {.height_m = h,
          .lumbar_m = (kBackHeight - kHip) * h,
          .thorax_m = (kShoulder - kBackHeight) * h,
          .neck_m = (kChin + kHeadRadius - kShoulder) * h,
          .head_m = (1.0 - kChin - 2.0 * kHeadRadius) * h,
          .clavicle_m = 0.129 * h,   // W
          .upper_arm_m = 0.186 * h,  // W
          .forearm_m = 0.146 * h,    // W
          .palm_m = 0.054 * h,       // half of W's hand
          .fingers_m = 0.042 * h,
          .half_hips_m = 0.048 * h,
          .thigh_m = (kHip - kKnee) * h,   // W
          .calf_m = (kKnee - kAnkle) * h,  // W
          .foot_m = 0.5 * 0.152 * h};      // W's foot less heel and tips, ankle to ball
}

Pose standing_pelvis(const BodyPlan& plan) {
  const double h = plan.height_m;
  // A little lower than with straight legs, so that the knees are bent and the hips can move; a
  // little to the left, so that the right hand is in front of the body.
  return {.position_m = {kPelvisAt_m * h / 1.75, -0.05 * h, (kHip - kOriginHeight - 0.018) * h}};
}

Vector3d standing_ankle_m(const BodyPlan& plan, bool right) {
  const double h = plan.height_m, side = right ? 1.0 : -1.0;
  const Vector3d pelvis_m = standing_pelvis(plan).position_m;
  return {pelvis_m.x() + 0.02 * h, pelvis_m.y() + side * 0.07 * h, (kAnkle - kOriginHeight) * h};
}

Vector3d upright_m(const BodyPlan& plan, FigureJoint joint) {
  const double chest_m = plan.lumbar_m + plan.thorax_m;
  switch (joint) {
    case FigureJoint::kBack:
      return {0.0, 0.0, plan.lumbar_m};
    case FigureJoint::kChest:
      return {0.0, 0.0, chest_m};
    case FigureJoint::kHead:
      return {0.0, 0.0, chest_m + plan.neck_m};
    case FigureJoint::kRightShoulder:
      return {0.0, plan.clavicle_m, chest_m};
    case FigureJoint::kLeftShoulder:
      return {0.0, -plan.clavicle_m, chest_m};
    case FigureJoint::kRightHip:
      return {0.0, plan.half_hips_m, 0.0};
    case FigureJoint::kLeftHip:
      return {0.0, -plan.half_hips_m, 0.0};
    default:
      return Vector3d::Zero();
  }
}

Quaterniond looking_down() { return Quaterniond(AngleAxisd(-kLooksDown_rad, Vector3d::UnitY())); }

Vector3d arm_along() { return Vector3d(-0.35, 0.25, -0.90).normalized(); }

Vector3d arm_bends_to() {
  const Vector3d along = arm_along(), forward(-1.0, -0.35, 0.1);
  return (forward - forward.dot(along) * along).normalized();
}

Chain arm_chain(const BodyPlan& plan) {
  const Vector3d up = Vector3d::UnitZ(), along = arm_along();
  const Vector3d hinge = along.cross(arm_bends_to());
  const auto ball = [](double length_m, const Vector3d& rest, double cone_rad) {
    return Bone{.kind = JointKind::kBall, .length_m = length_m, .rest = rest, .cone_rad = cone_rad};
  };
  const auto bend = [](double length_m, const Vector3d& rest, const Vector3d& axis, double lo_rad,
                       double hi_rad) {
    return Bone{
        .length_m = length_m, .rest = rest, .hinge = axis, .lo_rad = lo_rad, .hi_rad = hi_rad};
  };
  // Limits and cones: chosen, as in the table of body_plan.h.
  return {.bones = {bend(plan.lumbar_m, up, Vector3d::UnitY(), -0.60, 0.15),
                    ball(plan.thorax_m, up, 0.40), ball(plan.clavicle_m, Vector3d::UnitY(), 0.35),
                    ball(plan.upper_arm_m, along, 1.60),
                    bend(plan.forearm_m, along, hinge, 0.05, 2.50), ball(plan.palm_m, along, 1.10),
                    bend(plan.fingers_m, along, hinge, 0.10, 1.70)}};
}

std::array<JointState, kArmBones> arm_at_rest() {
  std::array<JointState, kArmBones> joints{};
  joints[kElbowBone].angle_rad = 1.2;
  joints[kFingerBone].angle_rad = 0.8;
  return joints;
}

std::array<Capsule, kCapsules> capsules(const BodyPlan& plan) {
  using enum FigureJoint;
  const double h = plan.height_m;
  const auto part = [h](FigureJoint a, FigureJoint b, double ra, double rb, double depth = 1.0) {
    return Capsule{a, b, ra * h, rb * h, depth};
  };
  const auto arm = [h](FigureJoint a, FigureJoint b, double ra, double rb, double depth = 1.0) {
    return Capsule{a, b, ra * h, rb * h, depth, true};
  };
  // Radii as shares of the height, and flattening front to back: chosen by eye.
  return {part(kPelvis, kBack, 0.080, 0.078, 0.72),
          part(kBack, kChest, 0.080, 0.070, 0.70),
          part(kLeftHip, kRightHip, 0.060, 0.060, 0.90),
          part(kChest, kHead, 0.034, 0.032),
          part(kHead, kCrown, kHeadRadius, kHeadRadius),
          part(kChest, kLeftShoulder, 0.040, 0.034),
          part(kLeftShoulder, kLeftElbow, 0.031, 0.023),
          part(kLeftElbow, kLeftWrist, 0.023, 0.015),
          part(kLeftWrist, kLeftKnuckles, 0.016, 0.021, 0.62),
          part(kLeftKnuckles, kLeftFingers, 0.019, 0.012, 0.6),
          part(kChest, kRightShoulder, 0.040, 0.034),
          arm(kRightShoulder, kRightElbow, 0.031, 0.023),
          arm(kRightElbow, kRightWrist, 0.023, 0.015),
          arm(kRightWrist, kRightKnuckles, 0.016, 0.021, 0.62),
          arm(kRightKnuckles, kRightFingers, 0.019, 0.010, 0.55),
          part(kLeftHip, kLeftKnee, 0.052, 0.034),
          part(kLeftKnee, kLeftAnkle, 0.034, 0.021),
          part(kLeftAnkle, kLeftToes, 0.021, 0.016),
          part(kRightHip, kRightKnee, 0.052, 0.034),
          part(kRightKnee, kRightAnkle, 0.034, 0.021),
          part(kRightAnkle, kRightToes, 0.021, 0.016),
          part(kPelvis, kChest, 0.070, 0.060, 0.75)};
}

}  // namespace tact::host::figure
