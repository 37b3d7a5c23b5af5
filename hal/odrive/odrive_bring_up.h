// SPDX-License-Identifier: Apache-2.0
// odrive_bring_up.h - three ODrives from power-on to ready for the loop, which alone arms them.
//
//     hear three heartbeats -> Idle -> Get_Version (0.6 answers, 0.5 does not) -> Clear_Errors ->
//     heartbeats without error, idle, often enough -> Set_Controller_Mode(torque, pass-through) ->
//     Set_Limits -> [index search] -> 0.5: [each axis alone: closed loop at zero torque, Idle] ->
//     positions of all three at the loop's rate
//
// Zero torque is sent all the while (odrive_listener.h). An axis of 0.5 that was never in closed
// loop since power-on says that it is at 0, wherever it is: nothing is homed on that (OD-2). The
// protocol acknowledges nothing: what can be seen in heartbeats and positions is checked, no more.
// Order and messages are those of ODrive's CANSimple manual (OD-2). Set-up code: blocks, at most
// some seconds; with an index search up to 20 s, while the arms move.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/can/can_bus.h"
#include "hal/delta/delta_kinematics.h"
#include "hal/odrive/odrive_delta.h"
#include "hal/odrive/odrive_errors.h"
#include "model/result.h"

namespace tact::hal::odrive {

/// The loop takes a drive for silent after this: three heartbeats of 100 ms and a little.
inline constexpr std::int64_t kOdriveSilence_ns = 350'000'000;
/// What opening refuses above: a beat that is a little late must not look like silence.
inline constexpr std::int64_t kSlowestHeartbeat_ns = 300'000'000;

struct OdriveStart {
  OdriveGeneration generation = OdriveGeneration::k06;
  delta::Joints motor_turns{};  // of arms at rest
};

/// What the device needs to hear.
std::vector<std::uint32_t> odrive_ids(const can::CanSettings& can);
/// Worst-case number of bits of all frames in a tick.
int odrive_cycle_bits(const OdriveSettings& settings);

model::Result<OdriveStart> bring_up_odrives(can::CanBus& bus, const model::DeviceSettings& settings,
                                            double rate_Hz);

}  // namespace tact::hal::odrive
