// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/falcon/falcon_wire.h"

#include <algorithm>

namespace tact::rig {
namespace {

constexpr std::uint8_t kStart = 0x3C, kEnd = 0x3E, kBias = 0x41, kMaxNibble = 0x50;
constexpr std::size_t kInfo = 13, kExtra = 14, kLast = 15;

void put_word(FalconFrame& frame, std::size_t word, int value) {
  const auto raw = static_cast<unsigned>(value) & 0xFFFFu;
  for (std::size_t i = 0; i < 4; ++i)
    frame[1 + 4 * word + i] = static_cast<std::uint8_t>((raw >> (4 * i) & 0xFu) + kBias);
}

int get_word(const FalconFrame& frame, std::size_t word) {
  unsigned raw = 0;
  for (std::size_t i = 0; i < 4; ++i)
    raw |= static_cast<unsigned>(frame[1 + 4 * word + i] - kBias) << (4 * i);
  return static_cast<std::int16_t>(raw);
}

std::array<int, 3> words(const FalconFrame& frame) {
  return {get_word(frame, 0), get_word(frame, 1), get_word(frame, 2)};
}

}  // namespace

FalconFrame encode_report(const FalconReport& report) {
  FalconFrame frame{};
  frame[0] = kStart;
  for (std::size_t i = 0; i < 3; ++i) put_word(frame, i, report.counts[i]);
  frame[kInfo] = static_cast<std::uint8_t>(kBias + (report.homed << 4 | report.buttons));
  frame[kExtra] = kBias;
  frame[kLast] = kEnd;
  return frame;
}

FalconReport decode_report(const FalconFrame& frame) {
  const int info = frame[kInfo] - kBias;
  return {words(frame), info & 15, info >> 4};
}

FalconCommand decode_command(const FalconFrame& frame) {
  const int info = frame[kInfo] - kBias;
  return {words(frame), (info & 1) != 0, info & 14};
}

std::optional<FalconFrame> FalconScanner::push(std::uint8_t byte) {
  // Neither mark can stand inside a frame: a start begins again, any other misfit drops what was.
  if (byte == kStart) {
    buffer_[0] = byte;
    size_ = 1;
    return std::nullopt;
  }
  const std::uint8_t largest = size_ == kInfo ? largest_info_ : kMaxNibble;
  const bool in_place = size_ > 0 && (size_ == kLast    ? byte == kEnd
                                      : size_ == kExtra ? byte != kEnd
                                                        : byte >= kBias && byte <= largest);
  if (!in_place) {
    size_ = 0;
    return std::nullopt;
  }
  buffer_[size_++] = byte;
  if (size_ < buffer_.size()) return std::nullopt;
  size_ = 0;
  return buffer_;
}

std::vector<std::uint8_t> ftdi_packet(FtdiStatus status, std::span<const std::uint8_t> data) {
  const std::size_t size = std::min(data.size(), kFtdiData);
  std::vector<std::uint8_t> packet(2 + size);
  packet[0] = status.modem;
  packet[1] = status.line;
  std::copy_n(data.begin(), size, packet.begin() + 2);
  return packet;
}

double ftdi_baud(std::uint16_t code) {
  constexpr double kEighths[] = {0.0, 0.5, 0.25, 0.125};
  if (code == 0) return 3e6;
  if (code == 1) return 2e6;
  return 3e6 / ((code & 0x3FFF) + kEighths[code >> 14]);
}

}  // namespace tact::rig
