// SPDX-License-Identifier: Apache-2.0
#include "host/figure/ccd.h"

#include <algorithm>
#include <cmath>

namespace tact::host::figure {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kNoDirection_m2 = 1e-24;  // a smaller square has no direction, CC-3 and CC-6
constexpr double kParallel = 1e-12;        // a smaller sine is parallel, CC-4
constexpr double kLimitSlack_rad = 1e-9;   // rounding of a state that an earlier call returned
constexpr double kSubChainShare = 0.98;    // share of its length up to which the sub chain is used

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A unit vector perpendicular to the unit vector v: the axis of a turn by pi.
Vector3d axis_across(const Vector3d& v) {
  const Vector3d across = v.cross(Vector3d::UnitZ());
  return (across.norm() > kParallel ? across : Vector3d(v.cross(Vector3d::UnitX()))).normalized();
}

/// True for a finite vector of a length above zero.
bool has_direction(const Vector3d& v) { return v.allFinite() && v.squaredNorm() > 0.0; }

bool is_valid(const Bone& bone, const JointState& joint) {
  // Conditions are written so that a NaN fails them.
  if (!(bone.length_m > 0.0 && std::isfinite(bone.length_m))) return false;
  if (!has_direction(bone.rest)) return false;
  if (bone.kind == JointKind::kHinge) {
    return has_direction(bone.hinge) && std::isfinite(bone.lo_rad) && std::isfinite(bone.hi_rad) &&
           bone.lo_rad <= joint.angle_rad && joint.angle_rad <= bone.hi_rad;
  }
  return bone.cone_rad >= 0.0 && bone.cone_rad <= pi && joint.rotation.coeffs().allFinite() &&
         std::abs(joint.rotation.norm() - 1.0) < kLimitSlack_rad &&
         swing_rad(bone, joint) <= bone.cone_rad + kLimitSlack_rad;
}

bool is_valid(const Chain& chain, std::span<const JointState> joints) {
  if (chain.bones.empty() || chain.bones.size() != joints.size()) return false;
  if (!chain.base_m.allFinite()) return false;
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (!is_valid(chain.bones[i], joints[i])) return false;
  return true;
}

/// A chain in motion: bones with unit directions, states, and the resulting points.
class Mover {
 public:
  Mover(const Chain& chain, std::span<const JointState> joints)
      : bones_(chain.bones),
        joints_(joints.begin(), joints.end()),
        parent_(bones_.size(), Quaterniond::Identity()),
        points_m_(bones_.size() + 1, chain.base_m) {
    for (Bone& bone : bones_) bone.rest.normalize(), bone.hinge.normalize();
    follow(0);
  }

  /// Turns joint i so that the end points at the target; false without a direction.
  bool turn(std::size_t i, const Vector3d& target_m) {
    const Vector3d ve = points_m_.back() - points_m_[i], vd = target_m - points_m_[i];
    if (!have_directions(ve, vd)) return false;
    const bool turned =
        bones_[i].kind == JointKind::kHinge ? turn_hinge(i, ve, vd) : turn_ball(i, ve, vd);
    if (turned) follow(i);
    return turned;
  }

  const Vector3d& end_m() const { return points_m_.back(); }
  const std::vector<JointState>& joints() const { return joints_; }
  const std::vector<Vector3d>& points_m() const { return points_m_; }

 private:
  static bool have_directions(const Vector3d& ve, const Vector3d& vd) {
    return ve.allFinite() && vd.allFinite() && ve.squaredNorm() >= kNoDirection_m2 &&
           vd.squaredNorm() >= kNoDirection_m2;
  }

  bool turn_hinge(std::size_t i, const Vector3d& ve, const Vector3d& vd) {
    // The axis is fixed in the parent's axes (CC-9).
    const Vector3d w = parent_[i] * bones_[i].hinge;
    const Vector3d flat_ve = ve - w * w.dot(ve), flat_vd = vd - w * w.dot(vd);
    if (!have_directions(flat_ve, flat_vd)) return false;
    // angle = atan2(w.(ve' x vd'), ve'.vd') ; clamp    (CC-6)
    const Vector3d from = flat_ve.stableNormalized(), to = flat_vd.stableNormalized();
    const double angle_rad = std::atan2(w.dot(from.cross(to)), from.dot(to));
    double& joint_rad = joints_[i].angle_rad;
    joint_rad = std::clamp(joint_rad + angle_rad, bones_[i].lo_rad, bones_[i].hi_rad);
    return true;
  }

  bool turn_ball(std::size_t i, const Vector3d& ve, const Vector3d& vd) {
    // angle = atan2(|ve x vd|, ve.vd), axis = (ve x vd)/|ve x vd|    (CC-4)
    const Vector3d from = ve.stableNormalized(), to = vd.stableNormalized();
    const Vector3d across = from.cross(to);
    const bool parallel = across.norm() < kParallel;
    // Parallel: nothing to turn. Opposite: any perpendicular axis will do.
    if (parallel && from.dot(to) > 0.0) return false;
    const AngleAxisd world = parallel ? AngleAxisd(pi, axis_across(from))
                                      : AngleAxisd(angle_between(from, to), across.normalized());
    // The same turn in the parent's axes, applied before the joint's own.
    const Quaterniond q =
        (parent_[i].conjugate() * world * parent_[i] * joints_[i].rotation).normalized();
    joints_[i].rotation = within_cone(bones_[i], q);
    return true;
  }

  /// Forward kinematics from joint i outwards.
  void follow(std::size_t i) {
    for (; i < bones_.size(); ++i) {
      // Normalized at each joint, because a product of many rotations would drift from length 1.
      const Quaterniond here = (parent_[i] * rotation_of(bones_[i], joints_[i])).normalized();
      points_m_[i + 1] = points_m_[i] + here * (bones_[i].length_m * bones_[i].rest);
      if (i + 1 < bones_.size()) parent_[i + 1] = here;
    }
  }

  std::vector<Bone> bones_;
  std::vector<JointState> joints_;
  std::vector<Quaterniond> parent_;  // n; world rotation of the axes in which joint i turns
  std::vector<Vector3d> points_m_;   // n + 1
};

/// CC-8: true if the lengths from `root` on cannot span this distance.
bool out_of_reach(std::span<const Bone> bones, double distance_m, double tolerance_m) {
  double sum_m = 0.0, longest_m = 0.0;
  for (const Bone& bone : bones) {
    sum_m += bone.length_m;
    longest_m = std::max(longest_m, bone.length_m);
  }
  // A bone longer than all others together leaves an unreachable sphere around the root.
  const double hole_m = std::max(2.0 * longest_m - sum_m, 0.0);
  return distance_m > sum_m + tolerance_m || distance_m < hole_m - tolerance_m;
}

}  // namespace

Bone planar_bone(double length_m, double lo_rad, double hi_rad) {
  return {.length_m = length_m, .lo_rad = lo_rad, .hi_rad = hi_rad};
}

Quaterniond rotation_of(const Bone& bone, const JointState& joint) {
  if (bone.kind == JointKind::kBall) return joint.rotation;
  return Quaterniond(AngleAxisd(joint.angle_rad, bone.hinge));
}

double swing_rad(const Bone& bone, const JointState& joint) {
  if (bone.kind == JointKind::kHinge) return joint.angle_rad;
  return angle_between(bone.rest, joint.rotation * bone.rest);
}

Quaterniond within_cone(const Bone& bone, const Quaterniond& q) {
  const Vector3d bone_now = q * bone.rest;
  // Angle of the bone from rest; its turn about itself is free (CC-7).
  const double swing = angle_between(bone.rest, bone_now);
  if (bone.kind == JointKind::kHinge || swing <= bone.cone_rad) return q;
  const Vector3d across = bone.rest.cross(bone_now);
  const Vector3d axis = across.norm() > kParallel ? across.normalized() : axis_across(bone.rest);
  return (AngleAxisd(bone.cone_rad - swing, axis) * q).normalized();
}

std::vector<Vector3d> joint_points_m(const Chain& chain, std::span<const JointState> joints) {
  if (!is_valid(chain, joints)) return {};
  return Mover(chain, joints).points_m();
}

std::size_t choose_root(const Chain& chain, std::span<const JointState> joints,
                        std::size_t sub_root, const Vector3d& target_m) {
  const std::vector<Vector3d> points_m = joint_points_m(chain, joints);
  if (points_m.empty() || sub_root >= joints.size()) return 0;
  double sum_m = 0.0;
  for (std::size_t i = sub_root; i < joints.size(); ++i) sum_m += chain.bones[i].length_m;
  // Nearly stretched, the sub chain would need many sweeps for a small gain, so the chest helps.
  return (target_m - points_m[sub_root]).norm() <= kSubChainShare * sum_m ? sub_root : 0;
}

ReachResult reach(const Chain& chain, std::span<const JointState> start, const Reach& goal) {
  ReachResult out;
  if (!is_valid(chain, start) || !goal.target_m.allFinite()) return out;
  if (!(goal.tolerance_m > 0.0 && std::isfinite(goal.tolerance_m))) return out;
  if (goal.sweeps < 0 || goal.sweeps > kMaxSweeps || goal.root >= start.size()) return out;

  Mover mover(chain, start);
  const auto error_m = [&] { return (mover.end_m() - goal.target_m).stableNorm(); };
  bool there = error_m() <= goal.tolerance_m;
  while (!there && out.sweeps < goal.sweeps) {
    ++out.sweeps;
    // CC-3: the outermost first, because it moves the least of the body.
    for (std::size_t i = start.size(); i-- > goal.root && !there;) {
      if (!mover.turn(i, goal.target_m)) continue;
      ++out.updates;
      there = error_m() <= goal.tolerance_m;
    }
  }
  out.joints = mover.joints();
  out.points_m = mover.points_m();
  out.error_m = error_m();
  const double distance_m = (goal.target_m - out.points_m[goal.root]).stableNorm();
  if (there)
    out.status = ReachStatus::kConverged;
  else if (out_of_reach(std::span(chain.bones).subspan(goal.root), distance_m, goal.tolerance_m))
    out.status = ReachStatus::kUnreachable;
  else
    out.status = ReachStatus::kMaxIterations;
  return out;
}

}  // namespace tact::host::figure
