// SPDX-License-Identifier: Apache-2.0
// can_frame.h - one frame of a classic CAN bus with an 11-bit identifier, and its most bits.
//
// Bytes are those of SocketCAN's `struct can_frame` (linux/can.h), 16 of them, little endian:
//
//     0-3  identifier, with flags: bit 31 extended, bit 30 remote request, bit 29 error frame
//     4    length, 0 to 8          5-7  not used here          8-15  data
//
// Bits are those of ISO 11898-1 (CB-1, CB-2) for 8 n data bits: 34 + 8 n from the start of frame to
// the end of the checksum, where a bit of the other sign follows five equal ones ("stuffing"), then
// 13 fixed ones: three delimiters and acknowledge, 7 end of frame, 3 intermission. At 1 Mbit/s a
// bit is 1 us.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "model/rt.h"

namespace tact::hal::can {

inline constexpr std::uint32_t kCanLargestId = 0x7FF;
inline constexpr std::size_t kCanFrameBytes = 16;
using CanFrameBytes = std::array<std::uint8_t, kCanFrameBytes>;

struct CanFrame {
  using Bytes = CanFrameBytes;
  /// How its interface is set up, for a remedy.
  static constexpr const char* kLinkType = "type can bitrate 1000000";

  std::uint32_t id = 0;                // 0 to 0x7FF; the lower one wins the bus
  bool rtr = false;                    // a request for this identifier: a length but no data
  std::uint8_t length = 0;             // of the data, bytes, 0 to 8
  std::array<std::uint8_t, 8> data{};  // zero beyond `length`

  /// What a receiver may read: nothing of a request, nothing of a length that cannot be.
  std::span<const std::uint8_t> payload() const RT_SAFE {
    return std::span(data).first(rtr || length > 8 ? 0 : length);
  }
  bool operator==(const CanFrame&) const = default;
};

/// A data frame of `length` bytes, at most 8, all zero.
constexpr CanFrame make_can_frame(std::uint32_t id, std::uint8_t length) RT_SAFE {
  return {.id = id, .rtr = false, .length = length, .data = {}};
}

/// Whether it is a data frame of this identifier and length: what a decoder asks first.
constexpr bool is_data(const CanFrame& frame, std::uint32_t id, std::size_t length) RT_SAFE {
  return !frame.rtr && frame.id == id && frame.length == length;
}

/// Nothing if identifier or length are outside their ranges.
std::optional<CanFrameBytes> pack_can_frame(const CanFrame& frame) RT_SAFE;
/// Nothing for an error frame (see can_error.h), an extended identifier, a length above 8 or any
/// number of bytes but 16. Data beyond the length, and all of a remote request, is zeroed.
std::optional<CanFrame> unpack_can_frame(std::span<const std::uint8_t> bytes) RT_SAFE;

/// Bits on the bus at most, of a data frame of `length` bytes: with a stuff bit after every fourth
/// of those that are stuffed, and intermission. The budget of a cycle.
constexpr int most_can_bits(int length) RT_SAFE {
  const int stuffed = 34 + 8 * length;
  return stuffed + (stuffed - 1) / 4 + 13;
}

}  // namespace tact::hal::can
