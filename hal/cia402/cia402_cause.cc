// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_cause.h"

#include <fmt/core.h>

#include "hal/cia402/canopen_frames.h"
#include "hal/cia402/canopen_text.h"
#include "hal/cia402/cia402_state.h"

namespace tact::hal::cia402 {

std::string text_of_cia402_cause(const can::FaultCause& cause) {
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
    case Cia402Cause::kUnguarded:
      return "the drive does not take up its watch over the controller's heartbeat again (object "
             "1016): start tactd again";
    case Cia402Cause::kLeftOperational:
      return nmt_message(static_cast<NmtState>(cause.code));
  }
  return {};
}

}  // namespace tact::hal::cia402
