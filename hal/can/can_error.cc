// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_error.h"

#include "hal/can/can_frame.h"
#include "hal/can/little_endian.h"

namespace tact::hal::can {
namespace {

constexpr std::uint32_t kFlags = 7u << 29;
constexpr std::uint32_t kErrorFlag = 1u << 29;

}  // namespace

const char* CanError::text() const {
  if (has(CanErrorClass::kBusOff)) {
    return "The controller left the bus after too many errors: check wiring, termination and bit "
           "rate, then start again.";
  }
  if (has(CanErrorClass::kRestarted))
    return "The controller came back onto the bus: arm the drives again, their state is not known.";
  if (has(CanControllerState::kRxPassive)) {
    return "Too many receive errors, the bus can no longer be relied on: check cable, termination "
           "and bit rate.";
  }
  return "Too many transmit errors, the bus can no longer be relied on: are the drives powered and "
         "connected?";
}

std::optional<CanError> decode_can_error(std::span<const std::uint8_t> bytes) RT_SAFE {
  if (bytes.size() != kCanFrameBytes) return std::nullopt;
  const std::uint32_t word = get_u32(bytes, 0);
  if ((word & kFlags) != kErrorFlag || bytes[4] != 8) return std::nullopt;
  CanError error{.classes = word & ~kFlags};
  if (error.classes == 0) return std::nullopt;
  if (error.has(CanErrorClass::kController)) error.controller = bytes[9];
  return error;
}

}  // namespace tact::hal::can
