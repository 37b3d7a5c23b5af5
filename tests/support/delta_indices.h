// SPDX-License-Identifier: Apache-2.0
// delta_indices.h - how far a pose of a delta is from a singular one (DK-5).
#pragma once

#include <algorithm>
#include <cmath>

#include "hal/delta/delta_kinematics.h"

namespace tact::tests {

struct DeltaIndices {
  double least_transmission = 1.0;  // min |d_i| / (la lb)
  double least_rod_sigma = 0.0;     // smallest singular value of [s_1 s_2 s_3] / lb

  bool within_limits() const { return least_transmission >= 0.35 && least_rod_sigma >= 0.25; }
};

inline DeltaIndices delta_indices(const hal::delta::DeltaKinematics& delta,
                                  const model::Vec3& position_m,
                                  const hal::delta::Joints& theta_rad) {
  const hal::delta::DeltaGeometry& g = delta.geometry();
  const hal::delta::DeltaPose pose = delta.pose(position_m, theta_rad);
  DeltaIndices out;
  out.least_rod_sigma = model::singular_values(model::Mat3{pose.rod_m})[2] / g.forearm_m;
  for (const double lever_m2 : pose.lever_m2)
    out.least_transmission =
        std::min(out.least_transmission, std::abs(lever_m2) / (g.upper_arm_m * g.forearm_m));
  return out;
}

}  // namespace tact::tests
