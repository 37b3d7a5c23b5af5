#include "hal/odrive/odrive_trouble.h"

#include <fmt/core.h>

#include "hal/can/can_delta.h"
#include "hal/odrive/odrive_errors.h"

namespace tact::hal {
namespace {

const char* state_name(std::uint32_t state) {
  switch (static_cast<OdriveAxisState>(state)) {
    case OdriveAxisState::kIdle:
      return "idle";
    case OdriveAxisState::kFullCalibration:
      return "calibrating";
    case OdriveAxisState::kIndexSearch:
      return "looking for its index";
    case OdriveAxisState::kClosedLoop:
      return "in closed loop";
    case OdriveAxisState::kHoming:
      return "homing";
  }
  return "in another state";
}

std::string own_words(const FaultCause& cause) {
  switch (static_cast<OdriveCause>(cause.kind)) {
    case OdriveCause::kErrors05:
      return odrive_error_sentence(OdriveGeneration::k05, cause.code, 0);
    case OdriveCause::kErrors06:
      return odrive_error_sentence(OdriveGeneration::k06, cause.code, 0);
    case OdriveCause::kParts05:
      return odrive_error_sentence(OdriveGeneration::k05, 0, cause.code);
    case OdriveCause::kLeftClosedLoop:
      return fmt::format(
          "the drive left torque control by itself and is {}: read its errors with odrivetool",
          state_name(cause.code));
    case OdriveCause::kNotStarted:
      return fmt::format(
          "the drive does not enter closed loop and is {}: calibrate it with odrivetool "
          "(axis.requested_state), then save",
          state_name(cause.code));
    case OdriveCause::kSilent:
      return fmt::format(
          "no heartbeat for {} ms: check its supply and the CAN cable, then start tactd again",
          cause.code);
    case OdriveCause::kNoPosition:
      return fmt::format(
          "no new position for {} ms: check its supply and the CAN cable, then start tactd again",
          cause.code);
    case OdriveCause::kJumped:
      return "its position jumped without motion: the encoder slips or two drives share a node; "
             "check both and home again";
  }
  return {};
}

}  // namespace

std::string odrive_trouble(const FaultCause& cause, const model::DeviceSettings& device) {
  if (cause.fault == Fault::kNone || cause.axis > 2) return {};
  if (auto words = can_bus_trouble(cause, device.can.interface); !words.empty()) return words;
  if (auto words = homing_trouble(cause, device.delta); !words.empty()) return words;
  return fmt::format("{}: {}", can_arm_name(cause.axis, device.can), own_words(cause));
}

std::string odrive_error_sentence(OdriveGeneration generation, std::uint32_t axis_error,
                                  std::uint32_t parts) {
  const OdriveErrorWords* words = generation == OdriveGeneration::k06
                                      ? first_odrive_error(axis_error)
                                      : first_odrive_error_05(axis_error);
  if (words != nullptr) {
    return fmt::format("{} ({}, 0x{:X})", words->sentence, words->name, axis_error);
  }
  if ((parts & 1u) != 0) return "the motor reports an error: read axis.motor.error in odrivetool";
  if ((parts & 2u) != 0) {
    return "the encoder reports an error: read axis.encoder.error in odrivetool";
  }
  if ((parts & 4u) != 0) {
    return "the controller reports an error: read axis.controller.error in odrivetool";
  }
  return {};
}

std::uint32_t odrive_parts_05(const OdriveHeartbeat05& heartbeat) RT_SAFE {
  return (heartbeat.motor_error ? 1u : 0u) | (heartbeat.encoder_error ? 2u : 0u) |
         (heartbeat.controller_error ? 4u : 0u);
}

}  // namespace tact::hal
