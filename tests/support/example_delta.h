// SPDX-License-Identifier: Apache-2.0
// example_delta.h - the simulated delta as one on CAN; tools/deploy/devices.toml says the same.
#pragma once

#include "hal/can/can_settings.h"
#include "hal/sim/sim_delta_model.h"
#include "model/device_settings.h"

namespace tact::tests {

inline model::DeviceSettings example_delta() {
  namespace sim = hal::sim;
  model::DeviceSettings out;
  out.of<hal::can::DeltaSettings>() = {sim::kGeometry,
                                       sim::kMasses,
                                       sim::kMiddle_D_m,
                                       sim::kWorkspaceRadius_m,
                                       sim::kWorkspaceHalfLength_m,
                                       sim::kMaxForce_N,
                                       sim::kMaxJointTorque_Nm,
                                       /*joint_friction_Nm=*/0.01,
                                       /*joint_damping_Nms_per_rad=*/0.05,
                                       /*counts_per_turn=*/100'000.0,
                                       /*observer_bandwidth_Hz=*/40.0};
  out.of<hal::can::CanSettings>().direction = {1.0, 1.0, 1.0};
  return out;
}

}  // namespace tact::tests
