// cia402_trouble.h - why a delta with CiA 402 drives stopped, in words with the cure.
#pragma once

#include <string>

#include "hal/can/can_bus.h"
#include "model/device_settings.h"

namespace tact::hal {

/// Kinds of FaultCause, after those of the bus and of the homing.
enum class Cia402Cause : std::uint8_t {
  kEmergency = static_cast<std::uint8_t>(CanCause::kFirstOwn),  // code: of the EMCY message
  kStatus,                                                      // code: Cia402State, a fault
  kLeftEnabled,                                                 // code: Cia402State it is in
  kNotStarted,                                                  // code: Cia402State it is in
  kNotFollowing,     // enabled, but bit 12 says that it does not take the torque
  kSilent,           // code: for how long, ms
  kLeftOperational,  // code: NmtState
  kNoSample,         // code: for how long, ms
  kUnguarded,        // would not notice that the host is gone
};

/// Empty for the cause "none".
std::string cia402_trouble(const FaultCause& cause, const model::DeviceSettings& device);

}  // namespace tact::hal
