// SPDX-License-Identifier: Apache-2.0
// cia402_state.h - where a CiA 402 drive stands, from its statusword, and the way to torque.
//
//     statusword & 0x4F:  0x00 not ready  0x40 switch-on disabled  0x0F fault reaction  0x08 fault
//     statusword & 0x6F:  0x21 ready  0x23 switched on  0x27 operation enabled  0x07 quick stop
//
//     switch-on disabled -0x06-> ready -0x07-> switched on -0x0F-> operation enabled
//
// One step per statusword received (CN-2, CiA 402-2, object 6041 and 6040). Whatever fits no
// pattern is "unknown", which gets no command.
#pragma once

#include <cstdint>
#include <optional>

#include "model/rt.h"

namespace tact::hal::cia402 {

enum class Cia402State : std::uint8_t {
  kUnknown,
  kNotReady,
  kSwitchOnDisabled,
  kReady,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStop,
  kFaultReaction,
  kFault,
};
Cia402State cia402_state(std::uint16_t statusword) RT_SAFE;
const char* cia402_state_name(Cia402State state) RT_SAFE;

/// What else the statusword says.
struct Cia402Flags {
  bool warning;         // bit 7
  bool internal_limit;  // bit 11: the drive cuts the torque
  bool following;       // bit 12 while enabled: the drive takes the torque that it is sent
};
Cia402Flags cia402_flags(std::uint16_t statusword) RT_SAFE;

inline constexpr std::uint16_t kControlShutdown = 0x06;
inline constexpr std::uint16_t kControlSwitchOn = 0x07;
inline constexpr std::uint16_t kControlEnable = 0x0F;
inline constexpr std::uint16_t kControlDisableVoltage = 0x00;
inline constexpr std::uint16_t kControlQuickStop = 0x02;
inline constexpr std::uint16_t kControlFaultReset = 0x80;

/// The next command on the way to operation enabled, from the state and the command sent before: a
/// fault is reset by a rising edge, so 0x80 is never sent twice in a row. Nothing: wait. It resets
/// faults, so only a start may ask it; a loop that runs latches a fault and stays off.
std::optional<std::uint16_t> next_controlword(Cia402State state, std::uint16_t last) RT_SAFE;

}  // namespace tact::hal::cia402
