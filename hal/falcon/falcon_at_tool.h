// SPDX-License-Identifier: Apache-2.0
// falcon_at_tool.h - what a Falcon's joints and motor words are worth at the grip, at the worst
// pose.
//
//     b = b_joint / s^2,   c = c_joint / s,   D = s rad_per_count,
//     F = min over poses and axes of (4095 - dead_i) / (gain_i |row i of K^-T|)
//
// s: largest singular value of K^-1 over the workspace, m/rad. F: what the motor words can make in
// every direction, N. K: falcon_kinematics.h.
#pragma once

#include "hal/falcon/falcon_device.h"
#include "hal/falcon/falcon_kinematics.h"
#include "model/device_at_tool.h"

namespace tact::hal::falcon {

/// From a position to the force that answers it, beyond one hold: the command leaves with the next
/// USB frame, the report with the one after; without the event character the USB chip keeps it for
/// up to 1 ms more.
constexpr double falcon_delay_s(bool event_character) { return event_character ? 2e-3 : 3e-3; }

model::DeviceAtTool falcon_at_tool(const FalconKinematics& falcon, const FalconSettings& settings);
double falcon_max_force_N(const FalconKinematics& falcon, const FalconSettings& settings);

}  // namespace tact::hal::falcon
