// SPDX-License-Identifier: Apache-2.0
// device_types.h - which of Force Dimension's devices tact knows, and how strong each may be.
//
// A gripper has a motor and reports its angle, 0 closed (FD-4); its sign is that of
// the hand it is built for. All other types have a user button.
//
// Forces and radii are the defaults of CHAI3D (FD-1, chai3d.org, devices/CDeltaDevices.cpp), where
// they are below the data sheet; lengths and resolutions are those of the vendor's data sheets.
#pragma once

#include "hal/device.h"
#include "model/result.h"

namespace tact::hal::force_dimension {

struct ForceDimensionType {
  int code = 0;  // dhdGetSystemType
  const char* name = "";
  double max_force_N = 0.0;
  double max_torque_Nm = 0.0;  // 0: its wrist, if any, has no motors
  double radius_m = 0.0, half_length_m = 0.0;
  double resolution_m = 0.0;
  bool wrist = false;  // it measures an orientation
  GripKind grip = GripKind::kButton;
  bool left = false;  // for a left hand: its gripper counts the other way
  bool old = false;   // current SDKs no longer support it
};

/// Its gripper, fully open (FD-4).
inline constexpr double kGripperOpen_rad = 0.5236;
/// What its motor presses (FD-4).
inline constexpr double kGripperForce_N = 8.0;

/// The type of this code, or why it cannot be used and what can.
model::Result<ForceDimensionType> force_dimension_type(int code);

}  // namespace tact::hal::force_dimension
