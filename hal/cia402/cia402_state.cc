// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_state.h"

namespace tact::hal::cia402 {

Cia402State cia402_state(std::uint16_t statusword) RT_SAFE {
  // CN-2. In these four states bit 5 (quick stop) may be anything; in the next four it tells.
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
  switch (state) {
    case Cia402State::kUnknown:
      break;
    case Cia402State::kNotReady:
      return "not_ready_to_switch_on";
    case Cia402State::kSwitchOnDisabled:
      return "switch_on_disabled";
    case Cia402State::kReady:
      return "ready_to_switch_on";
    case Cia402State::kSwitchedOn:
      return "switched_on";
    case Cia402State::kOperationEnabled:
      return "operation_enabled";
    case Cia402State::kQuickStop:
      return "quick_stop_active";
    case Cia402State::kFaultReaction:
      return "fault_reaction_active";
    case Cia402State::kFault:
      return "fault";
  }
  return "unknown";
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

}  // namespace tact::hal::cia402
