// SPDX-License-Identifier: Apache-2.0
// coordinate_chain.h - transforms a tracker's own axes to the world, and a bone with its tracker.
//
//     R = Rz(gamma) Ry(beta) Rx(alpha)                               TR-1  alpha about x first
//     q = qz(gamma) qy(beta) qx(alpha)                               TR-2  the same as quaternion
//     p_inertial = q p_local q^-1                                    TR-3
//     p_world = p_inertial + o                                       TR-4
//     q_off = q_trk^-1 q_bone,  p_off = q_trk^-1 (p_bone - p_trk) q_trk    TR-5  once
//     q_bone = q_trk q_off,     p_bone = p_trk + q_trk p_off q_trk^-1      TR-6  every frame
//
//     q  Hamilton quaternion (w, x, y, z), unit; of q and -q, the same rotation, the one with
//        w > 0, at w = 0 the one whose first nonzero number of x, y, z is positive
//     p  point, m     o  origin of the local axes in the world, m
//     alpha, beta, gamma  angles, rad
//
// The source gives neither the order of the angles nor the direction of o; TR-1 and TR-4 are our
// choice. For display and registration, not for the force loop.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

namespace tact::host::pose {

struct EulerAngles {
  double alpha_rad = 0.0;  // about x
  double beta_rad = 0.0;   // about y
  double gamma_rad = 0.0;  // about z
};

/// Position and rotation of a body: p_world = rotation p_local + position.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

/// The one of q and -q that TR-2 defines.
Eigen::Quaterniond canonical(const Eigen::Quaterniond& q);
/// A tracker's four numbers as a rotation; nothing if they are zero or not finite.
std::optional<Eigen::Quaterniond> rotation_from(const std::array<double, 4>& wxyz);
/// TR-2: q = qz(gamma) qy(beta) qx(alpha).
Eigen::Quaterniond rotation_from(const EulerAngles& angles);

/// TR-3 and TR-4.
Eigen::Vector3d to_world(const Pose& local, const Eigen::Vector3d& p_local_m);
/// The inverse of to_world().
Eigen::Vector3d to_local(const Pose& local, const Eigen::Vector3d& p_world_m);

/// TR-5: the bone in the tracker's axes, computed once in the binding pose.
Pose bind(const Pose& tracker, const Pose& bone);
/// TR-6: the present pose of the bone from that of its tracker.
Pose drive(const Pose& tracker, const Pose& offset);

/// Interpolates on the shorter way from one pose to another; share 0 is `from`, 1 is `to`.
Pose between(const Pose& from, const Pose& to, double share);

}  // namespace tact::host::pose
