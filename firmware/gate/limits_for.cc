// SPDX-License-Identifier: Apache-2.0
#include "firmware/gate/limits_for.h"

#include <cmath>

namespace tact::firmware::gate {

model::Limits limits_for(const model::Limits& scene, const hal::DeviceInfo& device) {
  model::Limits limits = scene;
  limits.force_N = std::fmin(scene.force_N, device.max_force_N);
  limits.torque_Nm = std::fmin(scene.torque_Nm, device.max_torque_Nm);
  limits.workspace_radius_m = std::fmin(scene.workspace_radius_m, device.workspace_radius_m);
  limits.workspace_half_length_m =
      std::fmin(scene.workspace_half_length_m, device.workspace_half_length_m);
  return limits;
}

}  // namespace tact::firmware::gate
