// SPDX-License-Identifier: Apache-2.0
// limb.h - two bones in space: root and end are known, and to which side the middle joint bends.
//
//     x = (end - root) / |end - root|      y = the part of the hint across x, of length 1
//     the middle joint by CC-10 in the plane of x and y (leg_ik.h)
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
  Eigen::Vector3d end_m = Eigen::Vector3d::Zero();  // the wanted one, or the nearest in reach
  double missed_m = 0.0;                            // from there to the wanted one
};

/// The part of `v` across the unit vector `along`, of length 1; of `otherwise` if there is none.
Eigen::Vector3d across(const Eigen::Vector3d& v, const Eigen::Vector3d& along,
                       const Eigen::Vector3d& otherwise);

/// `hint` is a direction from the root, `otherwise` one for a limb that lies along it. An end at
/// the root gives no direction: the limb goes down, -z, then.
Limb pose_limb(const LimbBones& bones, const Eigen::Vector3d& root_m, const Eigen::Vector3d& end_m,
               const Eigen::Vector3d& hint, const Eigen::Vector3d& otherwise);

}  // namespace tact::host::figure
