// SPDX-License-Identifier: Apache-2.0
// falcon_packets.h - the 16 bytes that a Novint Falcon and its host exchange once its firmware
// runs.
//
//     3C | word 1 | word 2 | word 3 | info | extra | 3E        one report answers each command
//
//     word   signed 16 bit, two's complement: four bytes, least significant nibble first,
//            each nibble + 0x41, so 0x41..0x50
//     info   0x41 + bits.  command: 1 homing request, 2 green, 4 blue, 8 red light
//                          report:  1 plus, 2 forward, 4 centre, 8 minus button,
//                                   0x10 0x20 0x40 axis 1, 2, 3 is homed
//     extra  0x41 when sent; its meaning is unknown, so it is not read
//
// Axes seen from the front: 1 top, 2 right, 3 left. A positive motor word drives the thigh angle
// and the counts down. Motor words have no unit until they are calibrated on the device. Neither 3C
// nor 3E can occur inside. Source: FP-3, the protocol as found by K.
// Machulis, github.com/libnifalcon/libnifalcon.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "model/rt.h"

namespace tact::hal::falcon {

inline constexpr std::uint8_t kFalconStart = 0x3C, kFalconEnd = 0x3E;
inline constexpr std::uint8_t kFalconZero = 0x41;  // the byte of nibble 0
inline constexpr std::size_t kFalconPacketSize = 16;
inline constexpr int kFalconMotorMax = 4095;  // no measured device accepts a larger word

inline constexpr std::uint8_t kFalconHomingRequest = 0x1;
inline constexpr std::uint8_t kFalconGreen = 0x2, kFalconBlue = 0x4, kFalconRed = 0x8;
inline constexpr std::uint8_t kFalconLights = kFalconGreen | kFalconBlue | kFalconRed;
inline constexpr std::uint8_t kFalconPlus = 0x1, kFalconForward = 0x2, kFalconCentre = 0x4,
                              kFalconMinus = 0x8;
inline constexpr std::uint8_t kFalconAllHomed = 0x7;

using FalconWords = std::array<int, 3>;
using FalconPacket = std::array<std::uint8_t, kFalconPacketSize>;

struct FalconCommand {
  FalconWords motor{};
  std::uint8_t lights = 0;  // of kFalconLights
  bool homing = true;       // some firmware stays homed only while it is set
  bool operator==(const FalconCommand&) const = default;
};

struct FalconReport {
  FalconWords counts{};
  std::uint8_t buttons = 0;  // four bits
  std::uint8_t homed = 0;    // three bits
  /// Before that the counts mean nothing, and they jump when it becomes true.
  bool all_homed() const RT_SAFE { return homed == kFalconAllHomed; }
  bool operator==(const FalconReport&) const = default;
};

/// Motor words for these values, rounded. One beyond the range scales all three down, so the force
/// keeps its direction; NaN or infinity in any makes all zero.
FalconWords falcon_motor_words(const std::array<double, 3>& wanted) RT_SAFE;

/// Each word is clamped to +-kFalconMotorMax; bits that are no light are left out.
FalconPacket encode(const FalconCommand& command) RT_SAFE;
FalconPacket encode(const FalconReport& report) RT_SAFE;

/// Nothing unless it is one whole packet of that kind; a motor word out of range is damage.
std::optional<FalconCommand> decode_falcon_command(std::span<const std::uint8_t> bytes) RT_SAFE;
std::optional<FalconReport> decode_falcon_report(std::span<const std::uint8_t> bytes) RT_SAFE;

/// May a report have this byte at this place, 0..15?
bool falcon_report_may_have(std::uint8_t byte, std::size_t place) RT_SAFE;

/// Whole reports out of the bytes as they come: cut, damaged, with other bytes between. A start
/// byte cannot occur inside a packet, so each one begins a new packet; a byte that is wrong at
/// its place drops what was gathered, itself included. So a
/// report is never put together from two, none that arrived whole is lost, and each byte costs the
/// same time.
class FalconStream {
 public:
  /// The report that this byte completes, if any.
  std::optional<FalconReport> push(std::uint8_t byte) RT_SAFE;

  /// After a purge or a new start: what is gathered is no loss. The counters stay.
  void reset() RT_SAFE { size_ = 0; }

  std::uint64_t reports() const RT_SAFE { return reports_; }
  std::uint64_t dropped_bytes() const RT_SAFE { return dropped_bytes_; }
  std::size_t waiting_bytes() const RT_SAFE { return size_; }  // of a packet not yet whole

 private:
  FalconPacket packet_{};
  std::size_t size_ = 0;
  std::uint64_t reports_ = 0, dropped_bytes_ = 0;
};

}  // namespace tact::hal::falcon
