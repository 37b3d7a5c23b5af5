// SPDX-License-Identifier: Apache-2.0
// can_error.h - what an error frame says about the bus, in classes, in words, and what to do.
//
// The CAN driver reports trouble as frames with bit 29 of the identifier set (linux/can/error.h):
// the low identifier bits name classes, the data says more:
//
//     data[0] bit where arbitration was lost   data[1] controller state   data[2-3] protocol
//     data[4] transceiver                      data[6-7] error counters, if class 0x200 is set
//
// Counters of ISO 11898-1 (CB-3): below 96 active, from 96 warning, from 128 passive, at 256 the
// controller leaves the bus. A passive or absent controller may deliver torques late or never, so
// the drives are to be disabled; a bus that comes back by itself would resume on old state.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "model/rt.h"

namespace tact::hal::can {

enum class CanErrorClass : std::uint32_t {
  kTxTimeout = 0x001,
  kLostArbitration = 0x002,
  kController = 0x004,
  kProtocol = 0x008,
  kTransceiver = 0x010,
  kNoAck = 0x020,
  kBusOff = 0x040,
  kBusError = 0x080,
  kRestarted = 0x100,
  kCounters = 0x200,
};

/// Of the controller, in data[1].
enum class CanControllerState : std::uint8_t {
  kRxOverflow = 0x01,
  kTxOverflow = 0x02,
  kRxWarning = 0x04,
  kTxWarning = 0x08,
  kRxPassive = 0x10,
  kTxPassive = 0x20,
  kActive = 0x40,
};

/// What the host does about it, the mildest first.
enum class CanErrorAction : std::uint8_t { kLog, kCount, kWarn, kDisableDrives };

/// Where an error counter puts a controller.
enum class CanErrorLevel : std::uint8_t { kActive, kWarning, kPassive, kBusOff };
CanErrorLevel can_error_level(int error_count) RT_SAFE;

struct CanError {
  std::uint32_t classes = 0;    // bits of CanErrorClass
  std::uint8_t controller = 0;  // bits of CanControllerState; 0 without that class
  bool has_counters = false;    // else the next two are 0
  std::uint8_t tx_errors = 0;
  std::uint8_t rx_errors = 0;
  CanErrorAction action = CanErrorAction::kLog;  // by classes and controller state alone

  bool has(CanErrorClass one) const RT_SAFE {
    return (classes & static_cast<std::uint32_t>(one)) != 0;
  }
  bool has(CanControllerState one) const RT_SAFE {
    return (controller & static_cast<std::uint8_t>(one)) != 0;
  }
  /// By the worse of both counters: may be worse than the state that this frame reports.
  CanErrorLevel level() const RT_SAFE {
    return can_error_level(tx_errors > rx_errors ? tx_errors : rx_errors);
  }
};

/// Of the 16 bytes of a `struct can_frame`. Nothing if they are no error frame, are damaged (other
/// than 8 data bytes) or name no class at all.
std::optional<CanError> decode_can_error(std::span<const std::uint8_t> bytes) RT_SAFE;

/// A bit, its name in logs, and a message with the remedy.
struct CanErrorText {
  std::uint32_t bit;
  const char* name;
  const char* message;
};
std::span<const CanErrorText> can_error_class_texts() RT_SAFE;
std::span<const CanErrorText> can_controller_texts() RT_SAFE;
const char* can_error_action_name(CanErrorAction action) RT_SAFE;

}  // namespace tact::hal::can
