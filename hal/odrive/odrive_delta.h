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
#include "hal/can/can_settings.h"
#include "hal/device.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::odrive {

struct OdriveSettings {
  double max_velocity_turns_per_s = 0.0;  // of the motor, where the drive gives up
  double max_current_A = 0.0;             // both or none; 0: the drive's own limits stay
  bool short_torque = true;               // 4 bytes of torque, not 8: 32 us less on the bus

  void visit(model::ParameterVisitor& k, const model::DeviceSettings& device) {
    k.number("max_velocity_turns_per_s", {0.0, 1000.0}, "of an ODrive's motor; 0: the drive's own",
             max_velocity_turns_per_s, model::Need::kOptional);
    k.number("max_current_A", {0.0, 200.0}, "of an ODrive's motor; 0: the drive's own",
             max_current_A, model::Need::kOptional);
    if ((max_velocity_turns_per_s == 0.0) != (max_current_A == 0.0))
      k.refuse({"max_velocity_turns_per_s", "max_current_A"},
               "device.can needs both max_velocity_turns_per_s and max_current_A, or none: an "
               "ODrive takes them in one message");
    k.flag("short_torque", "ODrive: torque in 4 bytes, 32 us less on the bus", short_torque,
           model::Need::kOptional);
    if (max_current_A != 0.0)
      can::refuse_of_others(k, device, "can-odrive", "max_current_A", "an ODrive");
  }
};

/// From a bus that is open: what remains when interface and socket are checked.
model::Result<std::unique_ptr<Device>> start_odrive_delta(std::unique_ptr<can::CanBus> bus,
                                                          const model::DeviceSettings& settings,
                                                          double rate_Hz);

model::Result<std::unique_ptr<Device>> open_can_odrive(const model::DeviceSettings& settings,
                                                       double rate_Hz);

}  // namespace tact::hal::odrive
