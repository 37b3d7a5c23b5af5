// SPDX-License-Identifier: Apache-2.0
// tool_arm.h - the arm that holds the tool: seven joints from the pelvis to the finger tips.
//
//     1  all joints go a little towards rest, so that elbow and trunk do not drift
//     -  the trunk leans to where the trackers have it; what the arm bent it beyond that is kept
//        apart as `bent` and fades
//     2  the wrist goes to where the hand would hold the grip as it is wanted to
//     -  where the elbow is told, the upper arm turns about the line from shoulder to wrist, as far
//        as its cone lets it: the wrist stays
//     3  the wrist takes the wanted turn, as far as its cone lets it; the fingers curl
//     4  CCD brings the finger tips to the grip, if a limit kept the hand from its turn
//
// Steps 2 and 4 are CCD from the sub-root, the shoulder, and from the pelvis only when the target
// is farther than 0.98 of what the arm spans (choose_root), or when step 4 came to no good end
// because a limit of the arm is in the way: then it goes on from the pelvis. For the turn of the
// hand alone the trunk does not bend. Warm start, at most kSweeps sweeps each.
//
// From the shoulder step 2 begins with the two-bone formula, law of cosines as in CC-10: the elbow
// bends to the distance, then the shoulder points. Two updates, exact but for the limits. CCD alone
// needs as many updates from the shoulder as from the pelvis, because fewer joints take more
// sweeps: a joint that points at its target spoils the distance that the next one wanted.
//
// All points and rotations are in the pelvis's axes, m. Bones, limits: body_plan.h.
// For display rate, not for the force loop.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "host/figure/body_plan.h"

namespace tact::host::figure {

/// What the hand holds: the finger tips go to `grip_m`; `hand` turns the palm's rest axes. Of
/// `elbow_m` counts to which side of the line from shoulder to wrist it is.
struct ArmGoal {
  Eigen::Vector3d grip_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond hand = Eigen::Quaterniond::Identity();
  std::optional<Eigen::Vector3d> elbow_m{};
};

/// To compare with: kAlwaysFullChain is classical CCD, kFormulaAlone makes no sweep of the arm.
enum class RootRule : std::uint8_t { kSubRootFirst, kAlwaysFullChain, kFormulaAlone };

/// The chest ends lumbar and thorax, the shoulder the collar bone, too.
enum class TrunkEnd : std::uint8_t { kChest, kShoulder };

/// What a frame cost and gave.
struct ArmWork {
  bool reached = false;      // the finger tips are within kGripTolerance_m of the grip
  bool out_of_reach = true;  // the whole chain is too short
  bool full_chain = false;   // the sub-chain could not: too short, or a limit in the way
  double error_m = 0.0;
  int sweeps = 0, updates = 0;
};

inline constexpr int kSweeps = 20;
inline constexpr int kMaxSweepsPerFrame =
    3 * kSweeps;  // of a frame: wrist, grip, grip from the pelvis
inline constexpr double kGripTolerance_m = 0.5e-3;

class ToolArm {
 public:
  static constexpr std::size_t kBones = kArmBones;

  explicit ToolArm(const BodyPlan& plan, RootRule rule = RootRule::kSubRootFirst);

  /// Step 1: `share` of the way to rest, 0 .. 1.
  void relax(double share);
  /// Bends the trunk so that this end of it comes as near to `target_m` as it can, by `share` of
  /// the way.
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
  /// CCD from the joints as they are; counts what it costs.
  ReachResult run(const Chain& chain, const Eigen::Vector3d& target_m, double tolerance_m,
                  std::size_t root, ArmWork& work) const;
  ReachResult grip(const Eigen::Vector3d& grip_m, ArmWork& work);
  void take(const ReachResult& result);
  /// Elbow to the distance, shoulder to the direction; how many joints it turned.
  int point_two_bones(const Eigen::Vector3d& wrist_m);
  /// Elbow towards the side where `elbow_m` is; how many joints it turned.
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
  std::array<JointState, kShoulderBone> trunk_, bent_{};  // without the arm; by the arm beyond it
  std::array<Eigen::Vector3d, kBones + 1> points_m_{};
};

/// The hand that holds a tool by its handle: palm from the operator's side, finger tips down.
Eigen::Quaterniond holding_hand();

}  // namespace tact::host::figure
