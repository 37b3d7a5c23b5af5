// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_state.h"

#include <fmt/core.h>

#include <array>
#include <cstddef>

#include "hal/cia402/canopen_frames.h"
#include "hal/cia402/canopen_text.h"

namespace tact::hal::cia402 {

Cia402State cia402_state(std::uint16_t statusword) RT_SAFE {
  // CN-2. In these four states bit 5 (quick stop) may be anything; in the next four it decides.
  switch (statusword & 0x4Fu) {
    case 0x00:
      return Cia402State::kNotReady;
    case 0x40:
      return Cia402State::kSwitchOnDisabled;
    case 0x0F:
      return Cia402State::kFaultReaction;
    case 0x08:
      return Cia402State::kFault;
    default:
      break;
  }
  switch (statusword & 0x6Fu) {
    case 0x21:
      return Cia402State::kReady;
    case 0x23:
      return Cia402State::kSwitchedOn;
    case 0x27:
      return Cia402State::kOperationEnabled;
    case 0x07:
      return Cia402State::kQuickStop;
    default:
      return Cia402State::kUnknown;
  }
}

const char* cia402_state_name(Cia402State state) RT_SAFE {
  // In the order of Cia402State.
  constexpr std::array kNames{
      "unknown",     "not_ready_to_switch_on", "switch_on_disabled", "ready_to_switch_on",
      "switched_on", "operation_enabled",      "quick_stop_active",  "fault_reaction_active",
      "fault"};
  const auto place = static_cast<std::size_t>(state);
  return kNames[place < kNames.size() ? place : 0];
}

Cia402Flags cia402_flags(std::uint16_t statusword) RT_SAFE {
  const auto bit = [statusword](int n) { return ((statusword >> n) & 1) != 0; };
  // Bit 12 belongs to the mode: outside operation it says nothing about the torque.
  const bool enabled = cia402_state(statusword) == Cia402State::kOperationEnabled;
  return {.warning = bit(7), .internal_limit = bit(11), .following = enabled && bit(12)};
}

std::optional<std::uint16_t> next_controlword(Cia402State state, std::uint16_t last) RT_SAFE {
  switch (state) {
    case Cia402State::kSwitchOnDisabled:
      return kControlShutdown;
    case Cia402State::kReady:
      return kControlSwitchOn;
    case Cia402State::kSwitchedOn:
    case Cia402State::kOperationEnabled:
      return kControlEnable;
    case Cia402State::kQuickStop:
      return kControlDisableVoltage;
    case Cia402State::kFault:
      // Down, then up: only the rising edge resets.
      return (last & kControlFaultReset) != 0 ? kControlDisableVoltage : kControlFaultReset;
    case Cia402State::kUnknown:
    case Cia402State::kNotReady:
    case Cia402State::kFaultReaction:
      break;
  }
  return std::nullopt;
}

std::string text_of_cia402_cause(const FaultCause& cause) {
  const char* state = cia402_state_name(static_cast<Cia402State>(cause.code));
  switch (static_cast<Cia402Cause>(cause.kind)) {
    case Cia402Cause::kEmergency:
      return fmt::format("{} (code 0x{:04X})",
                         emergency_message(static_cast<std::uint16_t>(cause.code)), cause.code);
    case Cia402Cause::kStatus:
      return "the drive is in its fault state: read object 603F with its vendor's program";
    case Cia402Cause::kLeftEnabled:
      return fmt::format(
          "the drive left operation by itself and is {}: check its enable and safety inputs",
          state);
    case Cia402Cause::kNotStarted:
      return fmt::format(
          "the drive does not enable operation and is {}: check motor supply, enable and safety "
          "inputs",
          state);
    case Cia402Cause::kNotFollowing:
      return "the drive is enabled but does not follow the torque: does it support cyclic "
             "synchronous torque, and does a limit act?";
    case Cia402Cause::kWaits:
      return fmt::format(
          "the drive is {} (statusword 0x{:04X}); it is ready when motor supply, enable and STO "
          "are there",
          cia402_state_name(cia402_state(static_cast<std::uint16_t>(cause.code))), cause.code);
    case Cia402Cause::kExcessTorque:
      return fmt::format(
          "the drive gives {:.2f} N m that was not commanded (object 6077): set its torque offset "
          "(60B2) and friction compensation to 0, and check its commutation",
          1e-3 * static_cast<std::int32_t>(cause.code));
    case Cia402Cause::kUnguarded:
      return "the drive does not take up its watch over the controller's heartbeat again (object "
             "1016): start tactd again";
    case Cia402Cause::kLeftOperational:
      return nmt_message(static_cast<NmtState>(cause.code));
  }
  return {};
}

}  // namespace tact::hal::cia402
