// SPDX-License-Identifier: Apache-2.0
// falcon_wire.h - the Falcon's 16 bytes both ways, and the status bytes its USB adapter puts in
// front.
//
//     3C | word 1 | word 2 | word 3 | info + 41 | 41 | 3E
//     word: signed 16 bit, four bytes nibble + 41, least significant nibble first
//     every USB packet of the adapter: modem status, line status, at most 62 bytes of data
//
// Source: the protocol as found by K. Machulis, github.com/libnifalcon/libnifalcon; FTDI's status
// bytes as in the Linux driver ftdi_sio.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tact::rig {

using FalconFrame = std::array<std::uint8_t, 16>;

struct FalconCommand {
  std::array<int, 3> motor{};
  bool homing = false;
  int leds = 0;  // 2 green, 4 blue, 8 red
};
struct FalconReport {
  std::array<int, 3> counts{};
  int buttons = 0;  // bits 0..3
  int homed = 0;    // bits 0..2, axis 1..3
};

FalconFrame encode_report(const FalconReport& report);
FalconReport decode_report(const FalconFrame& frame);
FalconCommand decode_command(const FalconFrame& frame);

/// Whole frames out of a stream that may be damaged.
class FalconScanner {
 public:
  /// `largest_info`: 0x50 of commands, 0xC0 of reports.
  explicit FalconScanner(std::uint8_t largest_info) : largest_info_(largest_info) {}
  std::optional<FalconFrame> push(std::uint8_t byte);
  void clear() { size_ = 0; }

 private:
  FalconFrame buffer_{};
  std::size_t size_ = 0;
  std::uint8_t largest_info_;
};

/// What the adapter says of its lines.
struct FtdiStatus {
  std::uint8_t modem = 0x01, line = 0x60;
};
inline constexpr std::size_t kFtdiPacket = 64, kFtdiData = 62;
/// One packet; at most 62 bytes of data.
std::vector<std::uint8_t> ftdi_packet(FtdiStatus status, std::span<const std::uint8_t> data);
/// Baud of a divisor code: 3 MHz over integer part and eighths.
double ftdi_baud(std::uint16_t code);

}  // namespace tact::rig
