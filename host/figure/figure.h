// SPDX-License-Identifier: Apache-2.0
// figure.h - the operator at the device: trackers move the body, the tool moves the right arm.
//
//     waist            the pelvis                         TR-6
//     shoulder, head   the trunk leans so that the right shoulder, else the chest, reaches it;
//                      the neck does the rest, within a cone
//     hand, wrist      rotation of the right hand; its position comes from the tool only
//     elbow            direction of the right elbow around the line from shoulder to wrist
//     left hand        position and rotation of the left hand; the elbow bends down and outward
//                                                         TR-6, CC-10
//     leg, ankle       knee hint and foot, left and right  TR-6, CC-10
//     tool             not used: the device's own encoders are more accurate
//
// A bone is bound when its body is first tracked (TR-5), while the operator holds the neutral
// figure. The figure is placed so that its right shoulder meets the tracked one, if that is within
// kMaxPosition_m of the default. A bone without a tracker stays neutral; the head looks down at
// the device, the feet stand. bound_bone.h describes a body that is held, lost or tracked again.
//
// Time is an argument, s, of any clock; a step back resets the figure, with its bindings. All
// results are finite. Frame W, m. For display, not for the force loop. Source: CC-10,
// TR-1 to TR-6.
#pragma once

#include <algorithm>
#include <string>

#include "host/figure/bound_bone.h"
#include "host/figure/tool_arm.h"
#include "host/tracking/tracked_operator.h"

namespace tact::host::figure {

/// The hand grips a tool at this share of the tool's height above its tip, within these bounds.
inline constexpr double kGripHeight = 0.8, kMinGrip_m = 0.02, kMaxGrip_m = 0.3;
/// The grip in the tool's axes, m: the tip is their origin, the handle points along +z.
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
  double height_m = 0.0;  // of the body; 0: none yet
  std::array<Eigen::Vector3d, kFigureJoints> joint_m{};
  Eigen::Quaterniond head = Eigen::Quaterniond::Identity();  // the face looks along its -x
  Eigen::Vector3d grip_m = Eigen::Vector3d::Zero();          // target of the finger tips
  ArmWork arm;
  std::array<bool, 2> leg_reached{true, true};   // left, right: within kLimbTolerance_m; or free
  bool left_hand_reached = true;                 // likewise
  bool shoulder_too_far = false;                 // the tracked one was ignored
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
inline constexpr double kLimbTolerance_m = 0.01;  // allows a straight limb with a little noise
inline constexpr double kNeckCone_rad = 0.8, kHeadTurn_rad = 1.4;
inline constexpr double kRelax_s = 1.5;  // time constant of the arm's return to rest

class Figure {
 public:
  explicit Figure(const FigureSettings& settings = {});

  /// One frame. `tool`: the tool's pose in W; if it is not finite, the last one is kept.
  const FigurePose& update(double time_s, const Pose& tool, const TrackedOperator& bodies);
  /// Starts another run of the device, maybe with another tool: the clock restarts, bindings stay.
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
  Eigen::Vector3d start_m_ = Eigen::Vector3d::Zero();  // its place without a tracked shoulder
  Eigen::Vector3d place_m_ = Eigen::Vector3d::Zero();  // both relative to the default place
  std::optional<Eigen::Vector3d> place_goal_m_;        // of place_m_
  double waited_s_ = 0.0;                              // for the shoulder, then during the move
  bool may_bind_ = false;                              // the figure has reached its place
  double time_s_ = 0.0, dt_s_ = 0.0;
  bool begun_ = false;
};

}  // namespace tact::host::figure
