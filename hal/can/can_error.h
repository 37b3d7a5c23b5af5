// SPDX-License-Identifier: Apache-2.0
// can_error.h - what error frames say about the bus, and in words.
//
// The CAN driver reports faults as frames with bit 29 of the identifier set (linux/can/error.h):
// the low identifier bits name classes, data[1] is the controller's state if class 0x004 is set.
//
// A controller with too many errors is passive, then leaves the bus (CB-3). A passive or absent
// controller may deliver torques late or never, so the drives are to be disabled; a bus that comes
// back by itself would resume on old state.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "model/rt.h"

namespace tact::hal::can {

/// Kinds of FaultCause that all CAN devices have; the drives' own begin at kFirstOwn.
enum class CanCause : std::uint8_t {
  kCall = 1,        // of the bus; code: errno
  kNoRoom,          // twenty batches in a row
  kErrorFrame,      // code: classes, controller state << 16
  kBeyondStop = 8,  // of a lost homing; code: the arm's angle, mrad, two's complement
  kRodsApart,
  kSharedNode = 11,  // more replies than requests
  kSilent,           // of a drive; code: for how long, ms
  kNoPosition,       // code: for how long, ms
  kJumped,           // position without motion
  kForeign,          // code: the identifier of a command that this program did not send
  kFirstOwn = 16,
};

/// The classes that mean something here; a kernel sends others, too.
enum class CanErrorClass : std::uint16_t {
  kController = 0x004,
  kProtocol = 0x008,
  kNoAck = 0x020,
  kBusOff = 0x040,
  kBusError = 0x080,
  kRestarted = 0x100,
};

/// States of the controller, in data[1].
enum class CanControllerState : std::uint8_t { kRxPassive = 0x10, kTxPassive = 0x20 };

/// Content of one error frame, or of all so far.
struct CanError {
  std::uint32_t classes = 0;    // bits of CanErrorClass
  std::uint8_t controller = 0;  // bits of CanControllerState; 0 without that class

  bool has(CanErrorClass one) const RT_SAFE {
    return (classes & static_cast<std::uint32_t>(one)) != 0;
  }
  bool has(CanControllerState one) const RT_SAFE {
    return (controller & static_cast<std::uint8_t>(one)) != 0;
  }
  /// "Restarted" alone: bus-off was missed, and the drives' state is not known any more.
  bool is_bus_gone() const RT_SAFE {
    return has(CanErrorClass::kBusOff) || has(CanErrorClass::kRestarted) ||
           has(CanControllerState::kRxPassive) || has(CanControllerState::kTxPassive);
  }
  /// Why the bus is gone, with the remedy.
  const char* text() const;
};

/// Decodes a `struct can_frame`, 16 bytes. Nothing if they are no error frame, are damaged (other
/// than 8 data bytes) or name no class at all.
std::optional<CanError> decode_can_error(std::span<const std::uint8_t> bytes) RT_SAFE;

}  // namespace tact::hal::can
