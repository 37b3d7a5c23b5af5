// SPDX-License-Identifier: Apache-2.0
#include "host/figure/limb.h"

#include <cmath>

#include "host/figure/leg_ik.h"

namespace tact::host::figure {

using Eigen::Vector3d;

Vector3d across(const Vector3d& v, const Vector3d& along, const Vector3d& otherwise) {
  const Vector3d part = v - v.dot(along) * along;
  if (part.norm() > 1e-6) return part.normalized();
  return (otherwise - otherwise.dot(along) * along).normalized();
}

Limb pose_limb(const LimbBones& bones, const Vector3d& root_m, const Vector3d& end_m,
               const Vector3d& hint, const Vector3d& otherwise) {
  const Vector3d limb_m = end_m - root_m;
  const double distance_m = limb_m.norm();
  const Vector3d x = distance_m > 1e-6 ? Vector3d(limb_m / distance_m) : -Vector3d::UnitZ();
  const Vector3d y = across(hint, x, otherwise);
  const LegPose flat =
      pose_leg({.thigh_m = bones.upper_m, .calf_m = bones.lower_m}, {0.0, 0.0}, {distance_m, 0.0});
  const auto in_space = [&](const Eigen::Vector2d& p_m) -> Vector3d {
    return root_m + p_m.x() * x + p_m.y() * y;
  };
  return {.middle_m = in_space(flat.knee_m),
          .end_m = in_space(flat.ankle_m),
          .missed_m = std::abs(distance_m - flat.ankle_m.x())};
}

}  // namespace tact::host::figure
