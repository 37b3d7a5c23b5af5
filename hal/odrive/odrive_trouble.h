// odrive_trouble.h - why an ODrive delta stopped, in words with the cure.
#pragma once

#include <string>

#include "hal/can/can_bus.h"
#include "hal/odrive/odrive_protocol.h"
#include "model/device_settings.h"

namespace tact::hal {

/// Who answers Get_Version speaks 0.6.
enum class OdriveGeneration : std::uint8_t { k05, k06 };

/// Kinds of FaultCause, after those of the bus and of the homing.
enum class OdriveCause : std::uint8_t {
  kErrors05 = static_cast<std::uint8_t>(CanCause::kFirstOwn),  // code: axis_error of 0.5
  kErrors06,                                                   // code: axis_error of 0.6
  kParts05,         // code: 1 motor, 2 encoder, 4 controller; the axis itself reports nothing
  kLeftClosedLoop,  // code: the state it is in
  kNotStarted,      // code: the state it is in
  kSilent,          // code: for how long, ms
  kJumped,          // position without motion
  kNoPosition,      // code: for how long, ms
};

/// Empty for the cause "none".
std::string odrive_trouble(const FaultCause& cause, const model::DeviceSettings& device);

/// Sentence of the worst error of a heartbeat's word and the flags of kParts05; empty for none.
std::string odrive_error_sentence(OdriveGeneration generation, std::uint32_t axis_error,
                                  std::uint32_t parts);

/// Bits of kParts05 that a heartbeat of 0.5 has.
std::uint32_t odrive_parts_05(const OdriveHeartbeat05& heartbeat) RT_SAFE;

}  // namespace tact::hal
