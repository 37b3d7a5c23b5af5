// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_error.h"

#include <algorithm>

#include "hal/can/can_frame.h"
#include "hal/can/little_endian.h"

namespace tact::hal::can {
namespace {

constexpr std::uint32_t kFlags = 7u << 29;
constexpr std::uint32_t kErrorFlag = 1u << 29;

constexpr std::uint32_t bit(CanErrorClass one) { return static_cast<std::uint32_t>(one); }
constexpr std::uint32_t bit(CanControllerState one) { return static_cast<std::uint32_t>(one); }

constexpr CanErrorText kClassTexts[] = {
    {bit(CanErrorClass::kTxTimeout), "tx_timeout",
     "The CAN adapter did not get a frame onto the bus in time: is the bus overloaded?"},
    {bit(CanErrorClass::kLostArbitration), "lost_arbitration",
     "A frame with a lower identifier went first: normal on a shared bus."},
    {bit(CanErrorClass::kController), "controller",
     "The CAN controller reports a change of its own state."},
    {bit(CanErrorClass::kProtocol), "protocol",
     "A frame broke the rules of the bus: check bit rate, termination and cable."},
    {bit(CanErrorClass::kTransceiver), "transceiver",
     "The transceiver reports a wire fault: look for a broken or shorted CAN_H or CAN_L."},
    {bit(CanErrorClass::kNoAck), "no_ack",
     "Nobody acknowledged a frame: are the drives powered, connected and at this bit rate?"},
    {bit(CanErrorClass::kBusOff), "bus_off",
     "The controller left the bus after too many errors: check wiring, termination and bit rate, "
     "then start again."},
    {bit(CanErrorClass::kBusError), "bus_error",
     "The bus is disturbed: check the cable, its shield and both 120 ohm terminators."},
    {bit(CanErrorClass::kRestarted), "restarted",
     "The controller came back onto the bus: arm the drives again, their state is not known."},
    {bit(CanErrorClass::kCounters), "counters", "The frame carries the controller's error counts."},
};

constexpr CanErrorText kControllerTexts[] = {
    {bit(CanControllerState::kRxOverflow), "rx_overflow",
     "Received frames were lost: this machine reads the CAN bus too slowly."},
    {bit(CanControllerState::kTxOverflow), "tx_overflow",
     "Frames to send were lost: fewer frames per cycle, or a longer transmit queue."},
    {bit(CanControllerState::kRxWarning), "rx_warning",
     "Many receive errors: check cable and termination before they stop the device."},
    {bit(CanControllerState::kTxWarning), "tx_warning",
     "Many transmit errors: check cable and termination before they stop the device."},
    {bit(CanControllerState::kRxPassive), "rx_passive",
     "Too many receive errors, the bus can no longer be relied on: check cable, termination and "
     "bit rate."},
    {bit(CanControllerState::kTxPassive), "tx_passive",
     "Too many transmit errors, the bus can no longer be relied on: are the drives powered and "
     "connected?"},
    {bit(CanControllerState::kActive), "active", "The controller works without errors again."},
};

template <std::size_t n>
constexpr std::uint32_t all_bits(const CanErrorText (&words)[n]) {
  std::uint32_t bits = 0;
  for (const CanErrorText& one : words) bits |= one.bit;
  return bits;
}

CanErrorAction action_of(const CanError& error) RT_SAFE {
  using enum CanErrorClass;
  using enum CanControllerState;
  if (error.has(kBusOff) || error.has(kRxPassive) || error.has(kTxPassive))
    return CanErrorAction::kDisableDrives;
  // A bit that no table names comes from a newer kernel: somebody should look at it.
  const bool unknown = (error.classes & ~all_bits(kClassTexts)) != 0 ||
                       (error.controller & ~all_bits(kControllerTexts)) != 0;
  if (error.has(kRxWarning) || error.has(kTxWarning) || error.has(kTransceiver) || unknown)
    return CanErrorAction::kWarn;
  if (error.has(kTxTimeout) || error.has(kNoAck)) return CanErrorAction::kCount;
  return CanErrorAction::kLog;
}

}  // namespace

CanErrorLevel can_error_level(int error_count) RT_SAFE {
  if (error_count < 96) return CanErrorLevel::kActive;
  if (error_count < 128) return CanErrorLevel::kWarning;
  return error_count < 256 ? CanErrorLevel::kPassive : CanErrorLevel::kBusOff;
}

std::optional<CanError> decode_can_error(std::span<const std::uint8_t> bytes) RT_SAFE {
  if (bytes.size() != kCanFrameBytes) return std::nullopt;
  const std::uint32_t word = get_u32(bytes, 0);
  if ((word & kFlags) != kErrorFlag || bytes[4] != 8) return std::nullopt;
  CanError error{.classes = word & ~kFlags};
  if (error.classes == 0) return std::nullopt;
  const auto data = bytes.subspan(8);
  if (error.has(CanErrorClass::kController)) error.controller = data[1];
  error.has_counters = error.has(CanErrorClass::kCounters);
  if (error.has_counters) error.tx_errors = data[6], error.rx_errors = data[7];
  error.action = action_of(error);
  return error;
}

std::span<const CanErrorText> can_error_class_texts() RT_SAFE { return kClassTexts; }
std::span<const CanErrorText> can_controller_texts() RT_SAFE { return kControllerTexts; }

const char* can_error_action_name(CanErrorAction action) RT_SAFE {
  switch (action) {
    case CanErrorAction::kLog:
      return "log";
    case CanErrorAction::kCount:
      return "count";
    case CanErrorAction::kWarn:
      return "warn";
    case CanErrorAction::kDisableDrives:
      break;
  }
  return "disable_drives";
}

}  // namespace tact::hal::can
