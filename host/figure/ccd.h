// SPDX-License-Identifier: Apache-2.0
// ccd.h - bends a chain of bones until its end reaches a target: cyclic coordinate descent, started
// at the shoulder or hip (sub-root) instead of the chest, because most movements need no more.
//
//     p_0 .. p_n   joints and end E, m; bone i runs from p_i to p_(i+1)                    CC-1
//     e = |E - target| <= eps ends, at the start and after every joint                     CC-2
//     a sweep turns the joints n-1 .. root, the outermost first, each so that              CC-3
//     ve = E - p_i points along vd = target - p_i, then clamps it to its limits
//
//     ball:  angle = atan2(|ve x vd|, ve.vd) about ve x vd; the bone stays within `cone` of
//            its rest direction, the turn about the bone itself is free             CC-4, CC-7
//     hinge: the same about its axis w only, on ve and vd projected along w         CC-6
//     A planar chain is a chain of hinges about z at rest along +x                  CC-5
//
//     A joint's rotation is child <- parent, applied to the rest direction, which is given in the
//     parent's axes; a hinge turns about an axis fixed in the parent's axes.               CC-9
//
// Every returned state keeps the bone lengths and limits, even if the target was not reached. A
// straight chain that points at its target does not move (every angle is zero), so elbow and knee
// need limits that exclude 0; 0.05 rad are enough. For display rate, not for the force loop.
// Source: CC-1 to CC-9. Rotations are applied at once, as in the classical method.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace tact::host::figure {

enum class JointKind : std::uint8_t { kHinge, kBall };

struct Bone {
  JointKind kind = JointKind::kHinge;
  double length_m = 0.0;                             // > 0
  Eigen::Vector3d rest = Eigen::Vector3d::UnitX();   // its direction at rest, any length > 0
  Eigen::Vector3d hinge = Eigen::Vector3d::UnitZ();  // hinge: the axis, any length > 0
  double lo_rad = -std::numbers::pi;                 // hinge: limits of the angle
  double hi_rad = std::numbers::pi;
  double cone_rad = std::numbers::pi;  // ball: largest angle from rest, 0 .. pi
};

/// A bone of a chain in the x-y plane; its angle counts from the previous bone, the first from +x.
Bone planar_bone(double length_m, double lo_rad, double hi_rad);

struct JointState {
  double angle_rad = 0.0;                                        // hinge
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // ball
};

struct Chain {
  Eigen::Vector3d base_m = Eigen::Vector3d::Zero();  // p_0
  std::vector<Bone> bones;
};

inline constexpr int kMaxSweeps = 1000;

struct Reach {
  Eigen::Vector3d target_m = Eigen::Vector3d::Zero();
  double tolerance_m = 1e-3;  // eps > 0; a millimetre is enough for display
  int sweeps = 20;            // the cap, 0 .. kMaxSweeps
  std::size_t root = 0;       // joints before it do not move
};

enum class ReachStatus : std::uint8_t { kConverged, kMaxIterations, kUnreachable, kInvalid };

struct ReachResult {
  ReachStatus status = ReachStatus::kInvalid;
  std::vector<JointState> joints;         // n
  std::vector<Eigen::Vector3d> points_m;  // n + 1
  double error_m = 0.0;                   // e
  int sweeps = 0;                         // started
  int updates = 0;                        // joints turned; a joint without a direction is skipped
};

/// Positions of the joints and the end; empty if the chain or a state is invalid.
std::vector<Eigen::Vector3d> joint_points_m(const Chain& chain, std::span<const JointState> joints);
/// Child <- parent, CC-9; a hinge's axis has length 1 here.
Eigen::Quaterniond rotation_of(const Bone& bone, const JointState& joint);
/// Angle of a hinge, or the angle of a ball from rest.
double swing_rad(const Bone& bone, const JointState& joint);
/// Limits a ball's rotation to its cone, along the great circle through rest, which must have
/// length 1 here (CC-7); a hinge has no cone.
Eigen::Quaterniond within_cone(const Bone& bone, const Eigen::Quaterniond& q);

/// The sub-root if the target is within 0.98 of the sub chain's length, else 0, the chest.
std::size_t choose_root(const Chain& chain, std::span<const JointState> joints,
                        std::size_t sub_root, const Eigen::Vector3d& target_m);

/// CC-2 .. CC-8. kUnreachable: too far from the root, or too near, for these lengths; limits are
/// ignored. kInvalid: a length of 0, a start outside its limits, a number that is not finite.
ReachResult reach(const Chain& chain, std::span<const JointState> start, const Reach& goal);

}  // namespace tact::host::figure
