// SPDX-License-Identifier: Apache-2.0
// tool_arm.h - the arm that holds the tool: seven joints from the pelvis to the finger tips.
//
//     1  all joints move a little towards rest, so that elbow and trunk do not drift
//     -  the trunk leans as the trackers say; the arm's additional bend is stored separately as
//        `bent` and decays
//     2  the wrist moves to where the hand with its wanted rotation would hold the grip
//     -  if the elbow is given, the upper arm turns about the line from shoulder to wrist, as far
//        as its cone permits; the wrist does not move
//     3  the wrist takes the wanted rotation, as far as its cone permits; the fingers curl
//     4  CCD brings the finger tips to the grip, if a limit kept the hand from its rotation
//
// Steps 2 and 4 are CCD from the sub-root, the shoulder. They start at the pelvis only if the
// target is farther than 0.98 of the arm's span (choose_root); step 4 continues there if a limit of
// the arm made it fail. The trunk does not bend for the hand's rotation alone. Warm start, at most
// kSweeps sweeps each.
//
// From the shoulder, step 2 begins with the two-bone formula, the law of cosines as in CC-10: the
// elbow bends to the distance, then the shoulder points. This takes two updates and is exact within
// the limits. CCD alone needs as many updates from the shoulder as from the pelvis: with fewer
// joints it needs more sweeps, because each joint that points at its target changes the distance.
//
// All points and rotations are in the pelvis's axes, m. Bones, limits: body_plan.h.
// For display rate, not for the force loop.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "host/figure/body_plan.h"

namespace tact::host::figure {

/// Goal of the hand: the finger tips go to `grip_m`; `hand` rotates the palm's rest axes. `elbow_m`
/// only determines the direction of the elbow from the line between shoulder and wrist.
struct ArmGoal {
  Eigen::Vector3d grip_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond hand = Eigen::Quaterniond::Identity();
  std::optional<Eigen::Vector3d> elbow_m{};
};

/// For comparison: kAlwaysFullChain is classical CCD, kFormulaAlone makes no sweep of the arm.
enum class RootRule : std::uint8_t { kSubRootFirst, kAlwaysFullChain, kFormulaAlone };

/// kChest: the end of lumbar and thorax; kShoulder: that of the collar bone.
enum class TrunkEnd : std::uint8_t { kChest, kShoulder };

/// Effort and result of a frame.
struct ArmWork {
  bool reached = false;      // the finger tips are within kGripTolerance_m of the grip
  bool out_of_reach = true;  // the whole chain is too short
  bool full_chain = false;   // the sub-chain was too short, or a limit was in the way
  double error_m = 0.0;
  int sweeps = 0, updates = 0;
};

inline constexpr int kSweeps = 20;
inline constexpr int kMaxSweepsPerFrame = 3 * kSweeps;  // wrist, grip, grip from the pelvis
inline constexpr double kGripTolerance_m = 0.5e-3;

class ToolArm {
 public:
  static constexpr std::size_t kBones = kArmBones;

  explicit ToolArm(const BodyPlan& plan, RootRule rule = RootRule::kSubRootFirst);

  /// Step 1: moves all joints by `share`, 0 .. 1, of the way to rest.
  void relax(double share);
  /// Bends the trunk by `share` of the way that brings this end of it as near to `target_m` as
  /// possible.
  void lean(TrunkEnd end, const Eigen::Vector3d& target_m, double share);
  /// Steps 2 to 4. A goal that is not finite changes nothing.
  ArmWork hold(const ArmGoal& goal);

  /// Pelvis, back, chest, shoulder, elbow, wrist, knuckles, finger tips.
  const std::array<Eigen::Vector3d, kBones + 1>& points_m() const { return points_m_; }
  /// The axes of bone i, 0 .. kBones - 1.
  Eigen::Quaterniond axes(std::size_t i) const;
  const Chain& chain() const { return chain_; }
  const std::array<JointState, kBones>& joints() const { return joints_; }

 private:
  std::size_t root_for(const Chain& chain, const Eigen::Vector3d& target_m) const;
  /// CCD from the present joints; adds its effort to `work`.
  ReachResult run(const Chain& chain, const Eigen::Vector3d& target_m, double tolerance_m,
                  std::size_t root, ArmWork& work) const;
  ReachResult grip(const Eigen::Vector3d& grip_m, ArmWork& work);
  void take(const ReachResult& result);
  /// Elbow to the distance, shoulder to the direction; returns the number of joints turned.
  int point_two_bones(const Eigen::Vector3d& wrist_m);
  /// Turns the elbow towards `elbow_m`; returns the number of joints turned.
  int swivel(const Eigen::Vector3d& elbow_m);
  void bend_trunk();
  void note_bend();
  void turn_hand(const Eigen::Quaterniond& hand);
  Eigen::Vector3d wrist_for(const ArmGoal& goal) const;

  RootRule rule_;
  Chain chain_;
  Chain to_wrist_;                 // its first bones, up to the forearm
  std::array<Chain, 2> to_trunk_;  // by TrunkEnd
  std::array<JointState, kBones> rest_, joints_;
  std::array<JointState, kShoulderBone> trunk_, bent_{};  // by the trackers; added by the arm
  std::array<Eigen::Vector3d, kBones + 1> points_m_{};
};

/// The rotation of a hand at a tool's handle: palm from the operator's side, finger tips down.
Eigen::Quaterniond holding_hand();

}  // namespace tact::host::figure
