// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_at_tool.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/falcon/falcon_kinematics.h"
#include "hal/falcon/falcon_packets.h"

namespace tact::hal::falcon {
namespace {

/// K^-1 at the middle, the rims and between of the workspace cylinder.
template <typename Visit>
void visit_workspace(const FalconKinematics& falcon, Visit visit) {
  // 15 degrees: the azimuths of the legs, 105, -15 and -135 degrees (FK), are among them.
  constexpr int kAlong = 2, kOut = 2, kAround = 24;
  for (int i = -kAlong; i <= kAlong; ++i) {
    for (int j = 0; j <= kOut; ++j) {
      for (int k = 0; k < kAround; ++k) {
        const double r_m = kFalconRadius_m * j / kOut;
        const double angle_rad = 2.0 * std::numbers::pi * k / kAround;
        const Vec3 p_W{kFalconHalfLength_m * i / kAlong, r_m * std::cos(angle_rad),
                       r_m * std::sin(angle_rad)};
        const FalconInverse legs = falcon.inverse(falcon_point_D(p_W));
        if (legs.reachable) visit(model::inverse(falcon.joint_rate_matrix(legs)));
      }
    }
  }
}

}  // namespace

model::DeviceAtTool falcon_at_tool(const FalconKinematics& falcon, const FalconSettings& settings) {
  double s = 0.0;
  visit_workspace(falcon, [&](const model::Mat3& jacobian) {
    s = std::max(s, model::singular_values(jacobian)[0]);
  });
  // The angle is linear in the counts: any step gives it.
  const double rad_per_count = falcon_thigh_rad(1.0) - falcon_thigh_rad(0.0);
  return {.damping_Ns_per_m = s > 0.0 ? settings.joint_damping_Nms_per_rad / (s * s) : 0.0,
          .friction_N = s > 0.0 ? settings.joint_friction_Nm / s : 0.0,
          .position_step_m = s * rad_per_count,
          .delay_s = falcon_delay_s(settings.event_character)};
}

double falcon_max_force_N(const FalconKinematics& falcon, const FalconSettings& settings) {
  delta::Joints torque_Nm{};
  for (std::size_t i = 0; i < 3; ++i)
    torque_Nm[i] = (kFalconMotorMax - settings.dead_band_words[i]) / settings.gain_words_per_Nm[i];
  double force_N = kFalconMaxForce_N;
  visit_workspace(falcon, [&](const model::Mat3& jacobian) {
    const model::Mat3 torque_of_force = model::transpose(jacobian);  // tau = J^T F
    for (std::size_t i = 0; i < 3; ++i)
      // A force of any direction takes at most |row i| times itself from axis i.
      force_N = std::min(force_N, torque_Nm[i] / norm(torque_of_force.row[i]));
  });
  return force_N;
}

}  // namespace tact::hal::falcon
