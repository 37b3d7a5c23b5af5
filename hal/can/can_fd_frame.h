// SPDX-License-Identifier: Apache-2.0
// can_fd_frame.h - one frame of a CAN FD bus, with bit rate switch, and its cost in bits.
//
// Bytes are those of SocketCAN's `struct canfd_frame` (linux/can.h), 72 of them, little endian:
//
//     0-3  identifier, with flags: bit 31 extended, bit 29 error frame     4     length
//     5    flags: 1 bit rate switch, 4 CAN FD     6-7  not used here       8-71  data
//
// A length is 0 to 8, 12, 16, 20, 24, 32, 48 or 64. An identifier above 0x7FF goes as an extended
// one; a small one may come as either. The first 16 bytes are laid out as those of a classic frame,
// so an error frame is found in them (can_error.h).
//
// Bits are those of ISO 11898-1:2015 (CB-5). From the start of frame to the bit rate switch, and
// from the delimiter of the checksum on, they go at the slow rate, the others at the fast one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "model/rt.h"

namespace tact::hal::can {

/// Bit/s before and behind the bit rate switch, as kLinkType sets them.
inline constexpr int kCanFdSlow_bps = 1'000'000, kCanFdFast_bps = 5'000'000;
inline constexpr std::uint32_t kCanFdLargestId = 0x1FFF'FFFF;
inline constexpr std::size_t kCanFdFrameBytes = 72, kCanFdLargestLength = 64;
using CanFdFrameBytes = std::array<std::uint8_t, kCanFdFrameBytes>;

struct CanFdFrame {
  using Bytes = CanFdFrameBytes;
  /// How its interface is set up, for a remedy.
  static constexpr const char* kLinkType =
      "type can bitrate 1000000 dbitrate 5000000 sample-point 0.666 dsample-point 0.666 fd on";

  std::uint32_t id = 0;                                  // the lower one wins the bus
  std::uint8_t length = 0;                               // of the data, bytes
  std::array<std::uint8_t, kCanFdLargestLength> data{};  // zero beyond `length`

  std::span<const std::uint8_t> payload() const RT_SAFE {
    return std::span(data).first(length > kCanFdLargestLength ? 0 : length);
  }
  bool operator==(const CanFdFrame&) const = default;
};

/// The shortest length that a frame can have for so many bytes; nothing above 64.
std::optional<std::uint8_t> can_fd_length(std::size_t bytes) RT_SAFE;

/// Nothing if identifier or length cannot be.
std::optional<CanFdFrameBytes> pack_can_frame(const CanFdFrame& frame) RT_SAFE;
/// Nothing for an error frame, a remote request, a length that cannot be, or any number of bytes
/// but 72. Data beyond the length is zeroed.
std::optional<CanFdFrame> unpack_can_fd_frame(std::span<const std::uint8_t> bytes) RT_SAFE;

/// Worst-case number of bits of all frames in a tick, intermission included.
struct CanFdBits {
  int slow = 0, fast = 0;
};
/// Nothing for a frame that cannot be packed.
CanFdBits most_can_fd_bits(const CanFdFrame& frame) RT_SAFE;

/// Bit/s of a bus, > 0. Frames are twice as long on a bus at half the rate: the force is later, and
/// less stiffness is sound (HL-1). A virtual bus reports none; it counts as set up by kLinkType.
struct CanRate {
  double slow_bps = kCanFdSlow_bps;  // classic CAN has this one alone
  double fast_bps = kCanFdFast_bps;  // of CAN FD, behind the bit rate switch
};

constexpr double bus_time_s(int bits, const CanRate& rate) { return bits / rate.slow_bps; }
constexpr double bus_time_s(const CanFdBits& bits, const CanRate& rate) {
  return bits.slow / rate.slow_bps + bits.fast / rate.fast_bps;
}

}  // namespace tact::hal::can
