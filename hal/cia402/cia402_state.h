// SPDX-License-Identifier: Apache-2.0
// cia402_state.h - the state of a CiA 402 drive, from its statusword, and the way to torque.
//
//     statusword & 0x4F:  0x00 not ready  0x40 switch-on disabled  0x0F fault reaction  0x08 fault
//     statusword & 0x6F:  0x21 ready  0x23 switched on  0x27 operation enabled  0x07 quick stop
//
//     switch-on disabled -0x06-> ready -0x07-> switched on -0x0F-> operation enabled
//
// One step per statusword received (CN-2, CiA 402-2, object 6041 and 6040). What fits no
// pattern is "unknown", which gets no command.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/can/can_error.h"
#include "hal/fault_latch.h"
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

// --- Why a drive stops the force, or what it waits for. ---

/// Kinds of FaultCause, after those that all drives have.
enum class Cia402Cause : std::uint8_t {
  kEmergency = static_cast<std::uint8_t>(can::CanCause::kFirstOwn),  // code: of the EMCY message
  kStatus,                                                           // code: Cia402State, a fault
  kLeftEnabled,                                                      // code: Cia402State it is in
  kNotStarted,                                                       // code: Cia402State it is in
  kNotFollowing,     // enabled, but bit 12 says that it does not take the torque
  kLeftOperational,  // code: NmtState
  kUnguarded,        // would not notice that the host is gone
  kWaits,            // code: statusword; for motor supply, enable or STO, before any force
  kExcessTorque,     // code: mN m
};

/// For a person, with the remedy; empty for a cause that all drives have. Any thread.
std::string text_of_cia402_cause(const FaultCause& cause);

}  // namespace tact::hal::cia402
