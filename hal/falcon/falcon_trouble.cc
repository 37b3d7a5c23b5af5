// SPDX-License-Identifier: Apache-2.0
// What keeps a Falcon from making force, in words.
#include <fmt/core.h>

#include <array>
#include <cstring>

#include "hal/falcon/falcon_device.h"
#include "hal/falcon/ftdi_requests.h"

namespace tact::hal::falcon {
namespace {

// As seen from the front (FP-3).
constexpr std::array kAxis{"1 (top)", "2 (right)", "3 (left)"};

std::string missing_axes(std::uint8_t homed) {
  std::string out;
  for (std::size_t i = 0; i < kAxis.size(); ++i)
    if ((homed >> i & 1) == 0) out += fmt::format("{}{}", out.empty() ? "" : ", ", kAxis[i]);
  return out;
}

std::string line_text(std::uint8_t errors) {
  for (const std::uint8_t bit : {kFtdiBreak, kFtdiOverrun, kFtdiFraming, kFtdiParity})
    if ((errors & bit) != 0) return ftdi_line_error(bit);
  return "is another program or a bad cable on its line? Unplug its USB and power, plug both in "
         "again";
}

}  // namespace

std::string text_of(const FalconTrouble& t) {
  const char* const reason = std::strerror(t.error);
  switch (t.what) {
    case FalconTrouble::What::kNone:
      return {};
    case FalconTrouble::What::kNotHomed:
      return fmt::format(
          "the Falcon is not homed (axis {}): pull the grip all the way out, then push it in until "
          "the red light goes",
          missing_axes(t.homed));
    case FalconTrouble::What::kUnplugged:
      return "the Falcon is gone from USB: plug its cable in, into a port of its own, and start "
             "again";
    case FalconTrouble::What::kStalled:
      return "the Falcon's USB chip refuses a transfer (stall): unplug its USB and power, plug "
             "both in again";
    case FalconTrouble::What::kBroken:
      return fmt::format(
          "the Falcon's USB transfers fail ({}): change its cable and port, and use no hub",
          reason);
    case FalconTrouble::What::kSilent:
      return "the Falcon does not answer: is its power supply plugged in? Unplug power and USB for "
             "ten seconds, then start again";
    case FalconTrouble::What::kGarbled:
      return fmt::format("the Falcon's reports cannot be understood: {}", line_text(t.line_errors));
    case FalconTrouble::What::kHomingLost:
      return fmt::format(
          "the Falcon has lost its home (axis {}): start again, then pull the grip all the way out "
          "and push it in",
          missing_axes(t.homed));
    case FalconTrouble::What::kStoodIn:
      return "the loop gave the Falcon no command for 100 ms, so its USB thread took the force "
             "away: free the loop's core of other work, then start again";
  }
  return {};
}

}  // namespace tact::hal::falcon
