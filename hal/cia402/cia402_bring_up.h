// SPDX-License-Identifier: Apache-2.0
// cia402_bring_up.h - three CiA 402 drives from power-on to operational, without torque.
//
//     NMT pre-operational -> device type 402 (1000), torque mode (6502) -> it has a heartbeat
//     (1016, 1017) -> node guarding off (100C, 100D) -> a watch that a run before has left behind
//     off (1016) -> SYNC as it will come (1005, 1006, 1019) -> the settings of cia402_cst.h, each
//     reply checked -> mode (6061) -> quick stop disables (605A = 0, where the drive has it) -> old
//     fault reset -> rated torque (6076) -> position (6064) -> NMT start -> heartbeats say so; if
//     not, once more after NMT reset communication (cia402_network.h)
//
// Not every drive has 6007 (what it does when the host is lost) and 60C2 (its period): then its own
// settings count, which is reported. 6076 may be in the scene instead (CN-5).
//
// A quick stop that ramps would drive the arm against the hand, so the drive lets go instead. The
// host's own heartbeat is not sent here: a drive watches it from the first one on, and that is the
// loop's. CN-5, CiA 301, CiA 402-2. Set-up code: blocks, at most some seconds.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hal/can/can_bus.h"
#include "hal/cia402/cia402_cst.h"
#include "hal/cia402/cia402_delta.h"
#include "hal/delta/delta_kinematics.h"
#include "model/result.h"

namespace tact::hal::cia402 {

struct Cia402Start {
  std::array<double, 3> rated_torque_Nm{};
  delta::Joints motor_turns{};  // of arms at rest
  std::string caution{};        // settings that drives do not have; empty: none
};

/// What the device needs to hear.
std::vector<std::uint32_t> cia402_ids(const can::CanSettings& can);
/// Worst-case bits of SYNC, commands and samples in a tick; heartbeats and SDO come on top.
int cia402_cycle_bits();
/// For one drive at this rate.
CstConfiguration cst_settings(const Cia402Settings& settings, double rate_Hz);

model::Result<Cia402Start> bring_up_cia402(can::CanBus& bus, const model::DeviceSettings& settings,
                                           double rate_Hz);

}  // namespace tact::hal::cia402
