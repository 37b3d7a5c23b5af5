// SPDX-License-Identifier: Apache-2.0
// body_plan.h - lengths of an operator's bones, the standing pose at the device, and the capsules
// that draw the body. All lengths are shares of the body height H.
//
//     Segment lengths and joint heights: R. Drillis, R. Contini, Body Segment Parameters (1966), as
//     printed in D. Winter, Biomechanics and Motor Control of Human Movement, 4th ed. (2009),
//     fig. 4.1: shoulder 0.818 H, chin 0.870 H, hip 0.530 H, knee 0.285 H, ankle 0.039 H, half
//     shoulder breadth 0.129 H, upper arm 0.186 H, forearm 0.146 H, hand 0.108 H, foot 0.152 H
//     Not in there, and chosen: the back bends at 0.630 H, the hip joints are 0.096 H apart, a
//     curled hand is 0.054 H of palm and 0.042 H of fingers, the radii.
//
// Frame W: +x towards the operator, +y to the right, +z up. The operator looks along -x; the
// origin of W is 0.60 H above the floor, about a bench's height.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "host/figure/ccd.h"
#include "host/pose/coordinate_chain.h"

namespace tact::host::figure {

using pose::Pose;

enum class FigureJoint : std::uint8_t {
  kPelvis,
  kBack,   // the trunk bends here
  kChest,  // origin of both collar bones and of the neck
  kHead,
  kCrown,  // upper end of the head's capsule
  kLeftShoulder,
  kLeftElbow,
  kLeftWrist,
  kLeftKnuckles,
  kLeftFingers,
  kRightShoulder,
  kRightElbow,
  kRightWrist,
  kRightKnuckles,
  kRightFingers,  // hold the tool
  kLeftHip,
  kLeftKnee,
  kLeftAnkle,
  kLeftToes,
  kRightHip,
  kRightKnee,
  kRightAnkle,
  kRightToes,
};
inline constexpr std::size_t kFigureJoints = 23;
inline constexpr std::array<const char*, kFigureJoints> kFigureJointNames{
    "pelvis",         "back",        "chest",       "head",           "crown",
    "left shoulder",  "left elbow",  "left wrist",  "left knuckles",  "left fingers",
    "right shoulder", "right elbow", "right wrist", "right knuckles", "right fingers",
    "left hip",       "left knee",   "left ankle",  "left toes",      "right hip",
    "right knee",     "right ankle", "right toes"};

/// Lengths of bones, m, > 0.
struct BodyPlan {
  double height_m = 1.75;
  double lumbar_m, thorax_m, neck_m, head_m;
  double clavicle_m, upper_arm_m, forearm_m, palm_m, fingers_m;
  double half_hips_m, thigh_m, calf_m, foot_m;
};

/// For a height of 1.2 to 2.2 m; other heights are clamped.
BodyPlan make_body_plan(double height_m);

/// Pose of a standing operator's pelvis: upright, the right hand in front of the device.
Pose standing_pelvis(const BodyPlan& plan);
/// Position of a standing operator's right or left ankle; feet point along -x.
Eigen::Vector3d standing_ankle_m(const BodyPlan& plan, bool right);
/// Position of a joint in the pelvis's axes, upright.
Eigen::Vector3d upright_m(const BodyPlan& plan, FigureJoint joint);
/// Rotation of a head that looks down at the device, in the pelvis's axes.
Eigen::Quaterniond looking_down();

/// The seven joints from pelvis to finger tips, in the pelvis's axes. Sub-root: the shoulder.
///     0 lumbar    hinge   -0.60 .. 0.15 rad   bends the trunk forward, in its plane
///     1 thorax    ball    cone 0.40
///     2 clavicle  ball    cone 0.35
///     3 upper arm ball    cone 1.60 about forward and down
///     4 forearm   hinge   0.05 .. 2.50        excludes 0, where CCD cannot move a straight arm
///     5 palm      ball    cone 1.10
///     6 fingers   hinge   0.10 .. 1.70        towards the palm
Chain arm_chain(const BodyPlan& plan);
inline constexpr std::size_t kThoraxBone = 1, kShoulderBone = 3, kElbowBone = 4, kHandBone = 5,
                             kFingerBone = 6, kArmBones = 7;
/// The rest posture, which the arm approaches as far as the tool permits.
std::array<JointState, kArmBones> arm_at_rest();
/// In a bone's rest axes of the arm: direction along the bone, and direction of bending.
Eigen::Vector3d arm_along();
Eigen::Vector3d arm_bends_to();

/// A capsule between two joints with a radius at each; `depth_ratio` flattens it front to back.
struct Capsule {
  FigureJoint a, b;
  double radius_a_m, radius_b_m;
  double depth_ratio = 1.0;
  bool holds_tool = false;  // part of the arm that holds the tool
};
inline constexpr std::size_t kCapsules = 22;
std::array<Capsule, kCapsules> capsules(const BodyPlan& plan);

}  // namespace tact::host::figure
