#include "hal/cia402/cia402_trouble.h"

#include <fmt/core.h>

#include "hal/can/can_delta.h"
#include "hal/cia402/canopen_frames.h"
#include "hal/cia402/canopen_words.h"
#include "hal/cia402/cia402_state.h"

namespace tact::hal {
namespace {

const char* state_name(std::uint32_t code) {
  return cia402_state_name(static_cast<Cia402State>(code));
}

const char* nmt_words(std::uint32_t code) {
  switch (static_cast<NmtState>(code)) {
    case NmtState::kBoot:
      return "the drive restarted by itself: check its supply";
    case NmtState::kStopped:
      return "the drive was stopped over the bus: is a second controller on it?";
    case NmtState::kPreOperational:
      return "the drive went pre-operational: it lost the controller's heartbeat or had bus "
             "errors, or a second controller is on the bus";
    case NmtState::kOperational:
      break;
  }
  return "the drive left its normal state on the bus";
}

std::string own_words(const FaultCause& cause) {
  switch (static_cast<Cia402Cause>(cause.kind)) {
    case Cia402Cause::kEmergency:
      return fmt::format("{} (code 0x{:04X})",
                         emergency_sentence(static_cast<std::uint16_t>(cause.code)), cause.code);
    case Cia402Cause::kStatus:
      return "the drive is in its fault state: read object 603F with its maker's program";
    case Cia402Cause::kLeftEnabled:
      return fmt::format(
          "the drive left operation by itself and is {}: check its enable and safety inputs",
          state_name(cause.code));
    case Cia402Cause::kNotStarted:
      return fmt::format(
          "the drive does not enable operation and is {}: check motor supply, enable and safety "
          "inputs",
          state_name(cause.code));
    case Cia402Cause::kNotFollowing:
      return "the drive is enabled but does not follow the torque: does it support cyclic "
             "synchronous torque, and does a limit act?";
    case Cia402Cause::kSilent:
      return fmt::format(
          "no heartbeat for {} ms: check its supply and the CAN cable, then start tactd again",
          cause.code);
    case Cia402Cause::kNoSample:
      return fmt::format(
          "no position for {} ms: check its supply and the CAN cable, then start tactd again",
          cause.code);
    case Cia402Cause::kUnguarded:
      return "the drive does not take up its watch over the controller's heartbeat again (object "
             "1016): start tactd again";
    case Cia402Cause::kLeftOperational:
      return nmt_words(cause.code);
  }
  return {};
}

}  // namespace

std::string cia402_trouble(const FaultCause& cause, const model::DeviceSettings& device) {
  if (cause.fault == Fault::kNone || cause.axis > 2) return {};
  if (auto words = can_bus_trouble(cause, device.can.interface); !words.empty()) return words;
  if (auto words = homing_trouble(cause, device.delta); !words.empty()) return words;
  return fmt::format("{}: {}", can_arm_name(cause.axis, device.can), own_words(cause));
}

}  // namespace tact::hal
