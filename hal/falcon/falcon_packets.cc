// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_packets.h"

#include <algorithm>
#include <cmath>

namespace tact::hal::falcon {
namespace {

constexpr std::size_t kInfoPosition = 13, kExtraPlace = 14, kEndPlace = 15;
constexpr int kNibblesPerWord = 4;

FalconPacket packet(const FalconWords& words, unsigned info) RT_SAFE {
  FalconPacket out{};
  out[0] = kFalconStart;
  std::size_t place = 1;
  for (const int word : words) {
    // Two's complement: the lower four nibbles of a negative word are its 16 bits.
    unsigned rest = static_cast<unsigned>(word);
    for (int i = 0; i < kNibblesPerWord; ++i, rest >>= 4)
      out[place++] = static_cast<std::uint8_t>(kFalconZero + (rest & 0xFu));
  }
  out[kInfoPosition] = static_cast<std::uint8_t>(kFalconZero + info);
  out[kExtraPlace] = kFalconZero;
  out[kEndPlace] = kFalconEnd;
  return out;
}

bool is_packet(std::span<const std::uint8_t> bytes) RT_SAFE {
  if (bytes.size() != kFalconPacketSize) return false;
  for (std::size_t i = 0; i < kFalconPacketSize; ++i)
    if (!falcon_report_may_have(bytes[i], i)) return false;
  return true;
}

FalconWords text_of(std::span<const std::uint8_t> bytes) RT_SAFE {
  FalconWords out{};
  std::size_t place = 1;
  for (int& word : out) {
    unsigned bits = 0;
    for (int i = 0; i < kNibblesPerWord; ++i)
      bits |= static_cast<unsigned>(bytes[place++] - kFalconZero) << (4 * i);
    // Back from 16 bits with the sign.
    word = static_cast<std::int16_t>(bits);
  }
  return out;
}

}  // namespace

bool falcon_report_may_have(std::uint8_t byte, std::size_t place) RT_SAFE {
  if (place == 0) return byte == kFalconStart;
  if (place < kInfoPosition) return byte >= kFalconZero && byte <= kFalconZero + 0xF;
  if (place == kInfoPosition) return byte >= kFalconZero && byte <= kFalconZero + 0x7F;
  // Its meaning is unknown: anything but the two marks, so that finding the start stays exact.
  if (place == kExtraPlace) return byte != kFalconStart && byte != kFalconEnd;
  return place == kEndPlace && byte == kFalconEnd;
}

FalconWords falcon_motor_words(const std::array<double, 3>& wanted) RT_SAFE {
  double largest = 0.0;
  for (const double word : wanted) {
    if (!std::isfinite(word)) return {};
    largest = std::max(largest, std::abs(word));
  }
  const double range = kFalconMotorMax;
  // One factor for all three: cut words alone would turn the force.
  const double scale = largest > range ? range / largest : 1.0;
  FalconWords out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = static_cast<int>(std::lround(wanted[i] * scale));
  return out;
}

FalconPacket encode(const FalconCommand& command) RT_SAFE {
  FalconWords words{};
  for (std::size_t i = 0; i < 3; ++i)
    words[i] = std::clamp(command.motor[i], -kFalconMotorMax, kFalconMotorMax);
  const unsigned homing = command.homing ? kFalconHomingRequest : 0u;
  return packet(words, (command.lights & unsigned{kFalconLights}) | homing);
}

FalconPacket encode(const FalconReport& report) RT_SAFE {
  return packet(report.counts,
                (report.homed & unsigned{kFalconAllHomed}) << 4 | (report.buttons & 0xFu));
}

std::optional<FalconCommand> decode_falcon_command(std::span<const std::uint8_t> bytes) RT_SAFE {
  if (!is_packet(bytes)) return std::nullopt;
  const unsigned info = bytes[kInfoPosition] - unsigned{kFalconZero};
  // A command uses the lower four bits; the rest of 0x7F belongs to reports.
  if (info > 0xFu) return std::nullopt;
  const FalconWords words = text_of(bytes);
  for (const int word : words)
    if (std::abs(word) > kFalconMotorMax) return std::nullopt;
  return FalconCommand{.motor = words,
                       .lights = static_cast<std::uint8_t>(info & kFalconLights),
                       .homing = (info & kFalconHomingRequest) != 0};
}

std::optional<FalconReport> decode_falcon_report(std::span<const std::uint8_t> bytes) RT_SAFE {
  if (!is_packet(bytes)) return std::nullopt;
  const unsigned info = bytes[kInfoPosition] - unsigned{kFalconZero};
  return FalconReport{.counts = text_of(bytes),
                      .buttons = static_cast<std::uint8_t>(info & 0xFu),
                      .homed = static_cast<std::uint8_t>(info >> 4)};
}

std::optional<FalconReport> FalconStream::push(std::uint8_t byte) RT_SAFE {
  if (!falcon_report_may_have(byte, size_)) {  // a start byte may stand at place 0 only
    dropped_bytes_ += size_;
    size_ = 0;
  }
  if (size_ == 0 && byte != kFalconStart) {
    ++dropped_bytes_;
    return std::nullopt;
  }
  packet_[size_++] = byte;
  if (size_ < kFalconPacketSize) return std::nullopt;
  size_ = 0;
  ++reports_;
  return decode_falcon_report(packet_);
}

}  // namespace tact::hal::falcon
