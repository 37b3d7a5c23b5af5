// SPDX-License-Identifier: Apache-2.0
#include "host/figure/limb.h"

#include <algorithm>
#include <cmath>

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
  if (!std::isfinite(distance_m))
    return {.middle_m = root_m, .end_m = root_m, .missed_m = distance_m};
  const Vector3d x = distance_m > 1e-6 ? Vector3d(limb_m / distance_m) : -Vector3d::UnitZ();
  const Vector3d y = across(hint, x, otherwise);
  const double l1 = bones.upper_m, l2 = bones.lower_m;
  const double d = std::clamp(distance_m, std::abs(l1 - l2), l1 + l2);
  // 16 A^2 = (L1+L2+D) (L1+L2-D) (D+(L1-L2)) (D-(L1-L2)); a factor is exactly 0 for a straight or
  // folded limb, where acos of the law of cosines would lose half of its digits.
  const double product = ((l1 + l2) + d) * ((l1 + l2) - d) * (d + (l1 - l2)) * (d - (l1 - l2));
  const double along_m = d > 0.0 ? 0.5 * ((l1 - l2) * (l1 + l2) / d + d) : 0.0;
  const double across_m = d > 0.0 ? 0.5 * std::sqrt(std::max(product, 0.0)) / d : l1;
  return {.middle_m = root_m + along_m * x + across_m * y,
          .end_m = root_m + d * x,
          .missed_m = std::abs(distance_m - d)};
}

}  // namespace tact::host::figure
