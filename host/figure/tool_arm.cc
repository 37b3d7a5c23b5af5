// SPDX-License-Identifier: Apache-2.0
#include "host/figure/tool_arm.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact::host::figure {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Chosen below kGripTolerance_m, so that step 4 need not correct the wrist's error.
constexpr double kWristTolerance_m = 0.3e-3;
constexpr double kNoSide_m = 1e-3;  // an elbow nearer to the line from shoulder to wrist is ignored

Chain first_bones(const Chain& chain, std::size_t n) {
  Chain out{.base_m = chain.base_m, .bones = {}};
  out.bones.assign(chain.bones.begin(), chain.bones.begin() + static_cast<std::ptrdiff_t>(n));
  return out;
}

/// The turn about the unit vector `axis`, limited to keep `bone` within `cone_rad` of `rest`.
double turn_within(double turn_rad, const Vector3d& axis, const Vector3d& bone,
                   const Vector3d& rest, double cone_rad) {
  const Vector3d b = bone.normalized(), r = rest.normalized();
  const Vector3d side = b - b.dot(axis) * axis;
  // cos(angle to rest) = level + swing cos(turn - best)
  const double level = b.dot(axis) * r.dot(axis), x = side.dot(r), y = axis.cross(side).dot(r);
  const double swing = std::hypot(x, y), best_rad = std::atan2(y, x);
  const double half_rad =
      std::acos(std::clamp((std::cos(cone_rad) - level) / std::max(swing, 1e-12), -1.0, 1.0));
  return best_rad + std::clamp(std::remainder(turn_rad - best_rad, 2.0 * std::numbers::pi),
                               -half_rad, half_rad);
}

/// The rotation that maps two perpendicular directions to two others.
Quaterniond turn_from_to(const Vector3d& a, const Vector3d& b, const Vector3d& to_a,
                         const Vector3d& to_b) {
  Eigen::Matrix3d from, to;
  from << a, b, a.cross(b);
  to << to_a, to_b, to_a.cross(to_b);
  return Quaterniond(Eigen::Matrix3d(to * from.transpose())).normalized();
}

}  // namespace

Quaterniond holding_hand() {
  // Chosen by eye: the palm from the operator's side (-x), the finger tips down.
  const Vector3d palm = Vector3d(-0.85, -0.45, -0.28).normalized();
  const Vector3d down(-0.05, -0.15, -1.0);
  const Vector3d curl = (down - down.dot(palm) * palm).normalized();
  return turn_from_to(arm_along(), arm_bends_to(), palm, curl);
}

ToolArm::ToolArm(const BodyPlan& plan, RootRule rule)
    : rule_(rule),
      chain_(arm_chain(plan)),
      to_wrist_(first_bones(chain_, kHandBone)),
      to_trunk_{first_bones(chain_, kThoraxBone + 1), first_bones(chain_, kShoulderBone)},
      rest_(arm_at_rest()),
      joints_(rest_) {
  std::copy_n(rest_.begin(), kShoulderBone, trunk_.begin());
  turn_hand(holding_hand());
}

void ToolArm::relax(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  // Slerp towards rest stays in the cone: the bone's angle from rest decreases.
  const auto go = [s](JointState& joint, const JointState& rest) {
    joint.angle_rad += s * (rest.angle_rad - joint.angle_rad);
    joint.rotation = joint.rotation.slerp(s, rest.rotation).normalized();
  };
  for (std::size_t i = 0; i < kShoulderBone; ++i) {
    go(trunk_[i], rest_[i]);
    go(bent_[i], {});
  }
  for (std::size_t i = kShoulderBone; i < kHandBone; ++i) go(joints_[i], rest_[i]);
}

void ToolArm::lean(TrunkEnd end, const Vector3d& target_m, double share) {
  if (!(share > 0.0)) return;
  const Chain& chain = to_trunk_[static_cast<std::size_t>(end)];
  const auto start = std::span(trunk_).first(chain.bones.size());
  const ReachResult result =
      reach(chain, start, {.target_m = target_m, .tolerance_m = 1e-3, .sweeps = kSweeps});
  for (std::size_t i = 0; i < result.joints.size(); ++i) {
    trunk_[i].angle_rad += share * (result.joints[i].angle_rad - trunk_[i].angle_rad);
    // Slerp between two states within the cone may leave it.
    trunk_[i].rotation = within_cone(
        chain.bones[i], trunk_[i].rotation.slerp(share, result.joints[i].rotation).normalized());
  }
}

/// Sets the trunk to the trackers' pose plus the arm's bend of the last frame.
void ToolArm::bend_trunk() {
  for (std::size_t i = 0; i < kShoulderBone; ++i) {
    const Bone& bone = chain_.bones[i];
    joints_[i].angle_rad =
        std::clamp(trunk_[i].angle_rad + bent_[i].angle_rad, bone.lo_rad, bone.hi_rad);
    joints_[i].rotation = within_cone(bone, (trunk_[i].rotation * bent_[i].rotation).normalized());
  }
}

void ToolArm::note_bend() {
  for (std::size_t i = 0; i < kShoulderBone; ++i) {
    bent_[i].angle_rad = joints_[i].angle_rad - trunk_[i].angle_rad;
    bent_[i].rotation = (trunk_[i].rotation.conjugate() * joints_[i].rotation).normalized();
  }
}

ArmWork ToolArm::hold(const ArmGoal& goal) {
  ArmWork work;
  if (!goal.grip_m.allFinite() || !goal.hand.coeffs().allFinite()) return work;
  bend_trunk();
  // The fingers start curled, so that step 4 finds the same grip in each frame.
  joints_[kFingerBone] = rest_[kFingerBone];
  const Vector3d wrist_m = wrist_for(goal);
  // Not for classical CCD (kAlwaysFullChain), which serves for comparison.
  if (rule_ != RootRule::kAlwaysFullChain) work.updates += point_two_bones(wrist_m);
  take(run(to_wrist_, wrist_m, kWristTolerance_m, root_for(to_wrist_, wrist_m), work));
  if (goal.elbow_m) work.updates += swivel(*goal.elbow_m);
  turn_hand(goal.hand);
  const ReachResult result = grip(goal.grip_m, work);
  take(result);
  note_bend();
  work.reached = result.status == ReachStatus::kConverged;
  work.error_m = result.error_m;
  std::copy(result.points_m.begin(), result.points_m.end(), points_m_.begin());
  return work;
}

std::size_t ToolArm::root_for(const Chain& chain, const Vector3d& target_m) const {
  if (rule_ == RootRule::kAlwaysFullChain) return 0;
  return choose_root(chain, std::span(joints_).first(chain.bones.size()), kShoulderBone, target_m);
}

ReachResult ToolArm::run(const Chain& chain, const Vector3d& target_m, double tolerance_m,
                         std::size_t root, ArmWork& work) const {
  const int sweeps = rule_ == RootRule::kFormulaAlone ? 0 : kSweeps;
  ReachResult result =
      reach(chain, std::span(joints_).first(chain.bones.size()),
            {.target_m = target_m, .tolerance_m = tolerance_m, .sweeps = sweeps, .root = root});
  work.sweeps += result.sweeps;
  work.updates += result.updates;
  work.full_chain |= root == 0 && result.updates > 0;
  return result;
}

/// Step 4. Continues from the result of the arm alone, so that the trunk bends only for the
/// remaining distance.
ReachResult ToolArm::grip(const Vector3d& grip_m, ArmWork& work) {
  const std::size_t root = root_for(chain_, grip_m);
  ReachResult result = run(chain_, grip_m, kGripTolerance_m, root, work);
  work.out_of_reach = root == 0 && result.status == ReachStatus::kUnreachable;
  if (root == 0 || result.status == ReachStatus::kConverged) return result;
  take(result);
  ReachResult whole = run(chain_, grip_m, kGripTolerance_m, 0, work);
  work.out_of_reach = whole.status == ReachStatus::kUnreachable;
  // Within its sweeps, the arm alone may have come nearer than the whole body.
  return whole.error_m < result.error_m ? whole : result;
}

int ToolArm::point_two_bones(const Vector3d& wrist_m) {
  const auto start = std::span(joints_).first(kHandBone);
  // Beyond the arm's reach the trunk must help, for which this formula has no solution.
  if (rule_ != RootRule::kFormulaAlone && root_for(to_wrist_, wrist_m) != kShoulderBone) return 0;
  const std::vector<Vector3d> at_m = joint_points_m(to_wrist_, start);
  const Vector3d to_target = wrist_m - at_m[kShoulderBone];
  if ((wrist_m - at_m.back()).norm() <= kWristTolerance_m || to_target.norm() < 1e-6) return 0;

  const Bone &upper = chain_.bones[kShoulderBone], &lower = chain_.bones[kElbowBone];
  // D^2 = L1^2 + L2^2 + 2 L1 L2 cos(flexion), because the hinge is perpendicular to both bones
  const double l1 = upper.length_m, l2 = lower.length_m;
  const double cosine = (to_target.squaredNorm() - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
  const double flexion_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
  joints_[kElbowBone].angle_rad = std::clamp(flexion_rad, lower.lo_rad, lower.hi_rad);
  // The smallest rotation of the shoulder, in its parent's axes.
  const Quaterniond parent = axes(kShoulderBone - 1);
  JointState& shoulder = joints_[kShoulderBone];
  const Quaterniond bent = shoulder.rotation * rotation_of(lower, joints_[kElbowBone]);
  const Vector3d wrist = l1 * (shoulder.rotation * upper.rest) + l2 * (bent * lower.rest);
  const auto turn = Quaterniond::FromTwoVectors(wrist, parent.conjugate() * to_target);
  shoulder.rotation = within_cone(upper, (turn * shoulder.rotation).normalized());
  return 2;
}

int ToolArm::swivel(const Vector3d& elbow_m) {
  if (!elbow_m.allFinite()) return 0;
  const std::vector<Vector3d> at_m = joint_points_m(to_wrist_, std::span(joints_).first(kHandBone));
  const Vector3d line_m = at_m[kHandBone] - at_m[kShoulderBone];
  if (line_m.norm() < kNoSide_m) return 0;
  const Vector3d axis = line_m.normalized();
  const auto beside = [&](const Vector3d& p_m) -> Vector3d {
    const Vector3d from_m = p_m - at_m[kShoulderBone];
    return from_m - from_m.dot(axis) * axis;
  };
  const Vector3d now = beside(at_m[kElbowBone]), wanted = beside(elbow_m);
  // A straight arm, or a tracker on the line, gives no direction.
  if (now.norm() < kNoSide_m || wanted.norm() < kNoSide_m) return 0;
  double turn_rad = std::atan2(axis.dot(now.cross(wanted)), now.dot(wanted));
  const Quaterniond parent = axes(kShoulderBone - 1);
  const Bone& upper = chain_.bones[kShoulderBone];
  turn_rad = turn_within(turn_rad, axis, at_m[kElbowBone] - at_m[kShoulderBone],
                         parent * upper.rest, upper.cone_rad);
  JointState& shoulder = joints_[kShoulderBone];
  const Quaterniond turn(Eigen::AngleAxisd(turn_rad, parent.conjugate() * axis));
  shoulder.rotation = within_cone(upper, (turn * shoulder.rotation).normalized());
  return 1;
}

void ToolArm::take(const ReachResult& result) {
  std::copy(result.joints.begin(), result.joints.end(), joints_.begin());
}

Vector3d ToolArm::wrist_for(const ArmGoal& goal) const {
  // Backwards from the grip: subtract the curled fingers, then the palm.
  const double curl_rad = joints_[kFingerBone].angle_rad;
  const Vector3d palm = goal.hand * arm_along();
  const Vector3d fingers =
      goal.hand * (std::cos(curl_rad) * arm_along() + std::sin(curl_rad) * arm_bends_to());
  return goal.grip_m - chain_.bones[kHandBone].length_m * palm -
         chain_.bones[kFingerBone].length_m * fingers;
}

void ToolArm::turn_hand(const Quaterniond& hand) {
  const Bone& bone = chain_.bones[kHandBone];
  JointState& wrist = joints_[kHandBone];
  wrist.rotation = (axes(kHandBone - 1).conjugate() * hand).normalized();
  wrist.rotation = within_cone(bone, wrist.rotation);
}

Quaterniond ToolArm::axes(std::size_t i) const {
  Quaterniond q = Quaterniond::Identity();
  for (std::size_t k = 0; k <= i; ++k) q = q * rotation_of(chain_.bones[k], joints_[k]);
  return q.normalized();
}

}  // namespace tact::host::figure
