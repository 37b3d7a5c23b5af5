// SPDX-License-Identifier: Apache-2.0
#include "firmware/gate/limits_for.h"

#include <cmath>

namespace tact::firmware::gate {
namespace {

/// 0 if one is NaN; std::fmin would return the other one.
double smaller(double scene, double device) {
  if (scene <= device) return scene;
  return device < scene ? device : 0.0;
}

}  // namespace

model::Limits limits_for(const model::Limits& scene, const hal::DeviceInfo& device) {
  model::Limits limits = scene;
  // A scene limits the force on the hand, which is motion_scale times the force on the tool.
  const double share = 1.0 / std::fmax(device.motion_scale, 1.0);
  limits.slew_N_per_s = share * scene.slew_N_per_s;
  limits.continuous_force_N = share * scene.continuous_force_N;
  limits.force_N = smaller(share * scene.force_N, device.max_force_N);
  // 0: not known. Not "> 0", so that NaN reaches smaller(), which returns 0.
  if (device.max_continuous_force_N != 0.0)
    limits.continuous_force_N = smaller(limits.continuous_force_N, device.max_continuous_force_N);
  limits.torque_Nm = smaller(scene.torque_Nm, device.max_torque_Nm);
  limits.grip_force_N = smaller(scene.grip_force_N, device.grip.max_force_N);
  limits.workspace_radius_m = smaller(scene.workspace_radius_m, device.workspace_radius_m);
  limits.workspace_half_length_m =
      smaller(scene.workspace_half_length_m, device.workspace_half_length_m);
  return limits;
}

}  // namespace tact::firmware::gate
