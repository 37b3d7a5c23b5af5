// SPDX-License-Identifier: Apache-2.0
// cia402_delta.h - a delta with three CiA 402 drives in cyclic synchronous torque: their rules.
//
//     write: [heartbeat of the host, every 5 ms]  command 1, 2, 3  SYNC        one sendmmsg
//     read:  the three samples of that SYNC, EMCY, heartbeats                  one recvmmsg
//
//     off --permit--> starting: 0x06 0x07 0x0F --all three enabled--> ready --not permitted--> off
//
// SYNC is the last frame, so all drives sample at one time, and what they saw is there at the next
// tick. On release they stop monitoring the host's heartbeat (heartbeat_guard.h). A drive that
// faults, leaves operation enabled or sends EMCY stops all three by quick stop, and no fault is
// ever reset here. Without the loop its heartbeat is missing and the drives stop by themselves
// (1016, 6007). A drive that repeats an old position in answer to a new SYNC cannot be
// distinguished from one at rest: its sample has no velocity that would say otherwise, as an
// ODrive's has (odrive_axis.h). CiA 301, CiA 402-2. The device itself is in can_device.h.
#pragma once

#include <memory>

#include "hal/can/can_bus.h"
#include "hal/can/can_settings.h"
#include "hal/device.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::cia402 {

struct Cia402Settings {
  double counts_per_motor_turn = 10'000.0;
  bool command_at_sync = false;  // RPDO type 1, if the drive insists
  double rated_torque_Nm = 0.0;  // what 1000 of object 6071 are; 0: the drive's own 6076

  void visit(model::ParameterVisitor& k, const model::DeviceSettings& device) {
    k.number("counts_per_motor_turn", {100.0, 1e8}, "increments of a CiA 402 drive",
             counts_per_motor_turn, model::Need::kOptional);
    k.flag("command_at_sync", "CiA 402: torque waits for SYNC, if the drive insists",
           command_at_sync, model::Need::kOptional);
    k.number("rated_torque_Nm", {0.0, 1000.0},
             "CiA 402: of a motor; 0: as the drive reports (6076)", rated_torque_Nm,
             model::Need::kOptional);
    if (rated_torque_Nm != 0.0)
      can::refuse_of_others(k, device, "can-cia402", "rated_torque_Nm", "a CiA 402 drive");
    if (command_at_sync)
      can::refuse_of_others(k, device, "can-cia402", "command_at_sync", "a CiA 402 drive");
  }
};

/// From a bus that is open: what remains when interface and socket are checked.
model::Result<std::unique_ptr<Device>> start_cia402_delta(std::unique_ptr<can::CanBus> bus,
                                                          const model::DeviceSettings& settings,
                                                          double rate_Hz);

model::Result<std::unique_ptr<Device>> open_can_cia402(const model::DeviceSettings& settings,
                                                       double rate_Hz);

}  // namespace tact::hal::cia402
