// SPDX-License-Identifier: Apache-2.0
// limb.h - two bones in space, from root, end and a hint for the side of the middle joint.
//
//     x = (end - root) / |end - root|      y = part of the hint perpendicular to x, of length 1
//     D = |end - root|, kept within |L1 - L2| .. L1 + L2 ,   A  area of the triangle, m^2
//     middle joint - root = (L1^2 - L2^2 + D^2)/(2 D) x + 2 A/D y                            CC-10
//
//     L1 upper, L2 lower bone, m.   At D = 0, with L1 = L2, the limb is folded along y.
//
// Frame and unit: those of the arguments, m. For display, not for the force loop. Source: CC-10.
#pragma once

#include <Eigen/Core>

namespace tact::host::figure {

struct LimbBones {
  double upper_m = 0.0, lower_m = 0.0;  // > 0
};

struct Limb {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end_m = Eigen::Vector3d::Zero();  // the wanted end, or the nearest in reach
  double missed_m = 0.0;                            // its distance from the wanted end
};

/// The part of `v` perpendicular to the unit vector `along`, of length 1; if zero, of `otherwise`.
Eigen::Vector3d across(const Eigen::Vector3d& v, const Eigen::Vector3d& along,
                       const Eigen::Vector3d& otherwise);

/// `hint` is a direction from the root, `otherwise` a substitute if the hint lies along the limb.
/// An end at the root gives no direction: the limb then points down, -z. If the end is not finite,
/// both points are at the root.
Limb pose_limb(const LimbBones& bones, const Eigen::Vector3d& root_m, const Eigen::Vector3d& end_m,
               const Eigen::Vector3d& hint, const Eigen::Vector3d& otherwise);

}  // namespace tact::host::figure
