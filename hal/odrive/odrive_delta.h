// SPDX-License-Identifier: Apache-2.0
// odrive_delta.h - a delta with three ODrives on one CAN bus: the rules of its drives.
//
//     off --permit--> starting --three heartbeats say closed loop--> ready --not permitted--> off
//     zero torque     zero torque, closed loop asked for            torques   zero torque, idle
//
// The drives run on their own clocks (OD-3). A fault sends zero torque and Estop, which a drive
// keeps until its errors are cleared; only opening the device again does that. Without the loop the
// drives' own watchdogs stop them (ODrive: axis.config.enable_watchdog, watchdog_timeout 0.005 to
// 0.02 s). The device itself is in can_device.h.
#pragma once

#include <memory>

#include "hal/can/can_bus.h"
#include "hal/device.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::odrive {

/// From a bus that is open: what remains when interface and socket are checked.
model::Result<std::unique_ptr<Device>> start_odrive_delta(std::unique_ptr<can::CanBus> bus,
                                                          const model::DeviceSettings& settings,
                                                          double rate_Hz);

model::Result<std::unique_ptr<Device>> open_can_odrive(const model::DeviceSettings& settings,
                                                       double rate_Hz);

}  // namespace tact::hal::odrive
