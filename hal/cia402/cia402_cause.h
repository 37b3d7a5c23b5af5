// SPDX-License-Identifier: Apache-2.0
// cia402_cause.h - why a CiA 402 drive stops the force, or what it waits for, and the remedy.
#pragma once

#include <cstdint>
#include <string>

#include "hal/can/can_device.h"

namespace tact::hal::cia402 {

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
};

/// For a person, with the remedy; empty for a cause that all drives have. Any thread.
std::string text_of_cia402_cause(const can::FaultCause& cause);

}  // namespace tact::hal::cia402
