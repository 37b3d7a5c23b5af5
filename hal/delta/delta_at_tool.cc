// SPDX-License-Identifier: Apache-2.0
#include "hal/delta/delta_at_tool.h"

#include <algorithm>
#include <numbers>

namespace tact::hal::delta {

model::DeviceAtTool delta_at_tool(const DeltaKinematics& delta, const DeltaJointQuality& joint,
                                  std::span<const Vec3> positions_m) {
  double s = 0.0;
  for (const Vec3& p_m : positions_m) {
    const DeltaInverse solved = delta.inverse(p_m);
    if (!solved.reachable) continue;
    s = std::max(s, workspace_indices(delta, p_m, solved.theta_rad).sigma_m_per_rad[0]);
  }
  return {.damping_Ns_per_m = s > 0.0 ? joint.viscous_Nms_per_rad / (s * s) : 0.0,
          .friction_N = s > 0.0 ? joint.coulomb_Nm / s : 0.0,
          .position_step_m = s * 2.0 * std::numbers::pi / joint.counts_per_turn,
          .delay_s = joint.delay_s};
}

}  // namespace tact::hal::delta
