// SPDX-License-Identifier: Apache-2.0
// figure.h - the operator at the device: trackers move the body, the tool moves the right arm.
//
//     waist            the pelvis                         TR-6
//     shoulder, head   the trunk leans so that the right shoulder, else the chest, comes there;
//                      the neck does the rest, within a cone
//     hand, wrist      how the right hand is turned; where it is, the tool alone says
//     elbow            where the right elbow is about the line from shoulder to wrist
//     left hand        wrist and turn of the left hand; the elbow bends down and outward
//                                                         TR-6, CC-10
//     leg, ankle       knee hint and foot, left and right  TR-6, CC-10
//     tool             not asked: the device's own encoders know better
//
// A bone is bound when its body is first tracked (TR-5): the operator stands as the neutral figure
// does. The figure then stands where its right shoulder meets the tracked one, if that is within
// kMaxPosition_m of the default. A bone without a tracker stays neutral; the head looks down at
// the device, the feet stand. A body that is held, lost or back: bound_bone.h.
//
// Time is an argument, s, of any clock; a step back begins again, binding and all. No number that
// is not finite comes out. Frame W, m. For display, not for the force loop. Source: CC-10,
// TR-1 to TR-6.
#pragma once

#include <algorithm>
#include <string>

#include "host/figure/bound_bone.h"
#include "host/figure/tool_arm.h"
#include "host/tracking/tracked_operator.h"

namespace tact::host::figure {

/// A hand takes a tool at this share of the tool's height above its tip, within these bounds.
inline constexpr double kGripHeight = 0.8, kMinGrip_m = 0.02, kMaxGrip_m = 0.3;
/// Where, in the tool's axes, m: its tip is their origin, its handle points along +z.
inline Eigen::Vector3d grip_m(double tool_height_m) {
  return {0.0, 0.0, std::clamp(kGripHeight * tool_height_m, kMinGrip_m, kMaxGrip_m)};
}

struct FigureSettings {
  double height_m = 1.75;
  Eigen::Vector3d grip_m{0.0, 0.0, 0.075};      // of the handle, in the tool's axes
  std::optional<Eigen::Vector3d> shoulder_m{};  // right, W, while none is tracked; none: default
  RootRule root_rule = RootRule::kSubRootFirst;
};

enum class FigureTrouble : std::uint8_t { kNone, kHeld, kLost, kOutOfReach };

struct FigurePose {
  double height_m = 0.0;  // of the body that it draws; 0: none yet
  std::array<Eigen::Vector3d, kFigureJoints> joint_m{};
  Eigen::Quaterniond head = Eigen::Quaterniond::Identity();  // its -x is where the face looks
  Eigen::Vector3d grip_m = Eigen::Vector3d::Zero();          // where the finger tips shall be
  ArmWork arm;
  std::array<bool, 2> leg_reached{true, true};  // left, right: within kLimbTolerance_m; or free
  bool left_hand_reached = true;                // likewise
  bool shoulder_too_far = false;  // the tracked one does not say where the figure stands
  FigureTrouble trouble = FigureTrouble::kNone;  // the worst
  std::string words;                             // "head lost (silent)"; empty if there is none

  const Eigen::Vector3d& operator[](FigureJoint joint) const {
    return joint_m[static_cast<std::size_t>(joint)];
  }
  Eigen::Vector3d& operator[](FigureJoint joint) {
    return joint_m[static_cast<std::size_t>(joint)];
  }
};

inline constexpr double kMaxPosition_m = 0.5;
inline constexpr double kLimbTolerance_m = 0.01;  // a straight limb, a little noise: no trouble
inline constexpr double kNeckCone_rad = 0.8, kHeadTurn_rad = 1.4;
inline constexpr double kRelax_s = 1.5;  // in which the arm goes two thirds of its way to rest

class Figure {
 public:
  explicit Figure(const FigureSettings& settings = {});

  /// One frame. `tool` is the tool's pose in W; one that is not finite leaves the last one.
  const FigurePose& update(double time_s, const Pose& tool, const TrackedOperator& bodies);
  /// Another run of the device, maybe another tool: the clock begins again, what is bound stays so.
  void go_on_with(const Eigen::Vector3d& tool_grip_m);
  const FigurePose& pose() const { return pose_; }
  const BodyPlan& plan() const { return plan_; }
  const ToolArm& arm() const { return arm_; }

 private:
  void settle(const TrackedOperator& bodies);
  const Pose& follow(BodyRole role, const TrackedOperator& bodies, const Pose& neutral);
  double share(BodyRole role) const { return bones_[static_cast<std::size_t>(role)].share(); }
  void pose_trunk(const TrackedOperator& bodies);
  void pose_arm(const Pose& tool, const TrackedOperator& bodies);
  void pose_head();
  void pose_left_arm(const TrackedOperator& bodies);
  void place_leg(bool right, const TrackedOperator& bodies);

  FigureSettings settings_;
  BodyPlan plan_;
  ToolArm arm_;
  std::array<BoundBone, kBodyRoles> bones_{};
  FigurePose pose_;
  Pose pelvis_, tool_;
  Eigen::Vector3d start_m_ = Eigen::Vector3d::Zero();  // where it stands untracked
  Eigen::Vector3d place_m_ = Eigen::Vector3d::Zero();  // both from the default place
  std::optional<Eigen::Vector3d> place_goal_m_;        // of place_m_
  double waited_s_ = 0.0;                              // for the shoulder, then on the way there
  bool may_bind_ = false;                              // it stands where it shall
  double time_s_ = 0.0, dt_s_ = 0.0;
  bool begun_ = false;
};

}  // namespace tact::host::figure
