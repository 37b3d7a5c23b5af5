// SPDX-License-Identifier: Apache-2.0
// moteus_delta.h - a delta with three moteus on one CAN FD bus: the rules of its drives.
//
//     off --permit--> starting --10 replies in a row of each: position mode, no torque--> ready
//     stop            zero torque                                                         torques
//
// Each tick asks each drive and commands it in one frame; its reply is read in the next tick, so a
// position is one period old. Each command is valid for 10 ms: without the loop the drive ends its
// torque itself (what it does then is its servo.timeout_mode, which CAN does not report), and only
// a stop brings it back (MO-3). A fault sends stop to all three, and a stop is the last word too.
// The device itself is in can_device.h.
#pragma once

#include <memory>

#include "hal/can/can_bus.h"
#include "hal/device.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::moteus {

/// From a bus that is open: what remains when interface and socket are checked.
model::Result<std::unique_ptr<Device>> start_moteus_delta(std::unique_ptr<can::CanFdBus> bus,
                                                          const model::DeviceSettings& settings,
                                                          double rate_Hz);

model::Result<std::unique_ptr<Device>> open_can_moteus(const model::DeviceSettings& settings,
                                                       double rate_Hz);

}  // namespace tact::hal::moteus
