// SPDX-License-Identifier: Apache-2.0
// example_delta.h - the simulated delta as one on CAN; tools/deploy/devices.toml says the same.
#pragma once

#include "hal/sim/sim_delta_model.h"
#include "model/device_settings.h"

namespace tact::tests {

inline model::DeviceSettings example_delta() {
  namespace sim = hal::sim;
  model::DeviceSettings out;
  out.delta = {.base_radius_m = sim::kGeometry.base_radius_m,
               .platform_radius_m = sim::kGeometry.platform_radius_m,
               .upper_arm_m = sim::kGeometry.upper_arm_m,
               .forearm_m = sim::kGeometry.forearm_m,
               .azimuth_rad = sim::kGeometry.azimuth_rad,
               .theta_min_rad = sim::kGeometry.theta_min_rad,
               .theta_max_rad = sim::kGeometry.theta_max_rad,
               .arm_kg = sim::kMasses.arm_kg,
               .arm_com_m = sim::kMasses.arm_com_m,
               .arm_inertia_kgm2 = sim::kMasses.arm_inertia_kgm2,
               .rotor_inertia_kgm2 = sim::kMasses.rotor_inertia_kgm2,
               .gear_ratio = sim::kMasses.gear_ratio,
               .forearm_kg = sim::kMasses.forearm_kg,
               .platform_kg = sim::kMasses.platform_kg,
               .middle_m = sim::kMiddle_D_m,
               .workspace_radius_m = sim::kWorkspaceRadius_m,
               .workspace_half_length_m = sim::kWorkspaceHalfLength_m,
               .max_force_N = sim::kMaxForce_N,
               .max_joint_torque_Nm = sim::kMaxJointTorque_Nm,
               .joint_friction_Nm = 0.01,
               .joint_damping_Nms_per_rad = 0.05,
               .counts_per_turn = 100'000.0,
               .observer_bandwidth_Hz = 40.0};
  out.can.direction = {1.0, 1.0, 1.0};
  return out;
}

}  // namespace tact::tests
