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

std::string missing_axes(std::uint32_t homed) {
  std::string out;
  for (std::size_t i = 0; i < kAxis.size(); ++i)
    if ((homed >> i & 1) == 0) out += fmt::format("{}{}", out.empty() ? "" : ", ", kAxis[i]);
  return out;
}

std::string line_text(std::uint32_t errors) {
  for (const std::uint8_t bit : {kFtdiBreak, kFtdiOverrun, kFtdiFraming, kFtdiParity})
    if ((errors & bit) != 0) return ftdi_line_error(bit);
  return "is another program or a bad cable on its line? Unplug its USB and power, plug both in "
         "again";
}

// What and remedy, by FalconCause; {} is the text of part_of.
constexpr std::array kTexts{
    "",
    "the Falcon is not homed (axis {}): pull the grip all the way out, then push it in until the "
    "red "
    "light goes",
    "the Falcon is gone from USB: plug its cable in, into a port of its own, and start again",
    "the Falcon's USB chip refuses a transfer (stall): unplug its USB and power, plug both in "
    "again",
    "the Falcon's USB transfers fail ({}): change its cable and port, and use no hub",
    "the Falcon does not answer: is its power supply plugged in? Unplug power and USB for ten "
    "seconds, then start again",
    "the Falcon's reports cannot be understood: {}",
    "the Falcon has lost its home (axis {}): start again, then pull the grip all the way out and "
    "push "
    "it in",
    "the loop gave the Falcon no command for 100 ms, so its USB thread took the force away: free "
    "the "
    "loop's core of other work, then start again",
};
static_assert(kTexts.size() == static_cast<std::size_t>(FalconCause::kStoodIn) + 1);

std::string part_of(FalconCause cause, std::uint32_t code) {
  if (cause == FalconCause::kBroken) return std::strerror(static_cast<int>(code));
  return cause == FalconCause::kGarbled ? line_text(code) : missing_axes(code);
}

}  // namespace

std::string text_of(FalconCause cause, std::uint32_t code) {
  const char* const text = kTexts.at(static_cast<std::size_t>(cause));
  return fmt::format(fmt::runtime(text), part_of(cause, code));
}

}  // namespace tact::hal::falcon
