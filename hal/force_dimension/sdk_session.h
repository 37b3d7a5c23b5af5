// SPDX-License-Identifier: Apache-2.0
// sdk_session.h - a Force Dimension device from "the library is loaded" to "ready for the loop".
//
// Opened, of a known type, calibrated, configured once in expert mode (time guard off, so that no
// call waits; watchdog on, so that a dead PC lets go, FD-3), and called some hundred times with its
// forces off, so that the library has touched all its memory. Set-up code only; tact locks its
// memory before, and the library's heap with it.
#pragma once

#include "hal/force_dimension/device_types.h"
#include "hal/force_dimension/force_dimension_device.h"
#include "hal/force_dimension/sdk_library.h"
#include "hal/mounting.h"
#include "hal/permission.h"

namespace tact::hal::force_dimension {

struct SdkSession {
  SdkFunctions sdk;
  char id = 0;
  ForceDimensionType type;
  double gripper_open_rad = kGripperOpen_rad;
  bool balances_weight = true;  // the library, for a base mounted as delivered
  int serial_number = 0;        // 0: the library does not report it
};

/// How the hand closes the jaws: what type and library have for it.
GripKind grip_of(const SdkSession& session);

/// Leaves nothing open when it fails.
model::Result<SdkSession> open_sdk_session(const ForceDimensionSettings& settings,
                                           bool trust_library, const Mounting& mounting = {},
                                           const SystemRoots& roots = {});

/// Zero force, forces off, closed. May block.
void close_sdk_session(const SdkSession& session);

}  // namespace tact::hal::force_dimension
