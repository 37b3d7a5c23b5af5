// SPDX-License-Identifier: Apache-2.0
#include "hal/delta/delta_at_tool.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/delta/delta_frame.h"

namespace tact::hal::delta {

std::vector<Vec3> workspace_samples_D(double radius_m, double half_length_m, double middle_m) {
  std::vector<Vec3> samples{Vec3{}};
  for (const double x_m : {-half_length_m, half_length_m}) {
    samples.push_back({x_m, 0.0, 0.0});
    // Every 30 degrees: the plane of each arm, and the middle between two.
    for (int i = 0; i < 12; ++i) {
      const double angle_rad = i * std::numbers::pi / 6.0;
      samples.push_back({x_m, radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad)});
    }
  }
  for (Vec3& p : samples) p = point_D(p, middle_m);
  return samples;
}

model::DeviceAtTool delta_at_tool(const DeltaKinematics& delta, const DeltaJointQuality& joint,
                                  std::span<const Vec3> positions_m) {
  double s = 0.0;
  for (const Vec3& p_m : positions_m) {
    const DeltaInverse solved = delta.inverse(p_m);
    // None reachable leaves no damping: the safe side.
    if (!solved.reachable) continue;
    s = std::max(s, model::singular_values(jacobian(delta.pose(p_m, solved.theta_rad)))[0]);
  }
  return {.damping_Ns_per_m = s > 0.0 ? joint.viscous_Nms_per_rad / (s * s) : 0.0,
          .friction_N = s > 0.0 ? joint.coulomb_Nm / s : 0.0,
          .position_step_m = s * 2.0 * std::numbers::pi / joint.counts_per_turn,
          .delay_s = joint.delay_s};
}

}  // namespace tact::hal::delta
