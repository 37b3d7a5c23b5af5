// SPDX-License-Identifier: Apache-2.0
// moteus_bring_up.h - three moteus from power-on to ready for the loop, which alone gives torque.
//
//     ask all three -> home state, register map -> stop -> stopped, with a position -> at rest
//
// Nothing that is sent here gives power. A stop clears a fault, so a drive that was in one is
// reported in `caution`; one that stays in it is refused. Refused too: a drive of another register
// map, one that reports no position or lacks what the loop asks for, one that another host drives,
// and absolute homing without an output reference (MO-4). Set-up code: blocks,
// at most some seconds.
#pragma once

#include <string>
#include <vector>

#include "hal/can/can_bus.h"
#include "hal/can/can_settings.h"
#include "hal/delta/delta_kinematics.h"
#include "hal/moteus/moteus_protocol.h"
#include "model/result.h"

namespace tact::hal::moteus {

struct MoteusStart {
  delta::Joints motor_turns{};  // of arms at rest
  std::string caution{};        // what was wrong and is cleared
};

/// What the device needs to hear.
std::vector<std::uint32_t> moteus_ids(const can::CanSettings& can);
/// Worst-case number of bits of all frames in a tick.
can::CanFdBits moteus_cycle_bits(const can::CanSettings& can);
/// What a reply lacks of what moteus_torque asks for, by name; nullptr: nothing.
const char* lacking_in(const MoteusReply& reply) RT_SAFE;

model::Result<MoteusStart> bring_up_moteus(can::CanFdBus& bus, const can::CanSettings& can);

}  // namespace tact::hal::moteus
