// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/can/wire.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tact::rig {
namespace {

std::span<const std::uint8_t> part(std::span<const std::uint8_t> payload, const WireField& field) {
  const std::size_t size = wire_size(field.type);
  if (field.offset + size > payload.size()) return {};
  return payload.subspan(field.offset, size);
}

struct Range {
  double least, largest;
};
Range range_of(WireType type) {
  const double bits = 8.0 * static_cast<double>(wire_size(type));
  const bool is_signed = type == WireType::kI8 || type == WireType::kI16 || type == WireType::kI32;
  if (is_signed) return {-std::exp2(bits - 1.0), std::exp2(bits - 1.0) - 1.0};
  // Of 64 bits the largest double below 2^64.
  return {0.0, bits > 53.0 ? std::exp2(bits) - 2048.0 : std::exp2(bits) - 1.0};
}

}  // namespace

void put_raw(std::span<std::uint8_t> bytes, std::uint64_t raw) {
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(raw & 0xFFu);
    raw >>= 8u;
  }
}

std::uint64_t get_raw(std::span<const std::uint8_t> bytes) {
  std::uint64_t raw = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) raw = raw << 8u | bytes[i];
  return raw;
}

void put_field(std::span<std::uint8_t> payload, const WireField& field, double value) {
  if (field.type == WireType::kBit) {
    const std::size_t byte = field.offset / 8u;
    if (byte >= payload.size()) return;
    const unsigned mask = 1u << (field.offset % 8u);
    payload[byte] =
        static_cast<std::uint8_t>(value != 0.0 ? payload[byte] | mask : payload[byte] & ~mask);
    return;
  }
  const std::size_t size = wire_size(field.type);
  if (field.offset + size > payload.size()) return;
  const auto bytes = payload.subspan(field.offset, size);
  if (field.type == WireType::kF32) {
    put_raw(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value / field.scale)));
    return;
  }
  const Range range = range_of(field.type);
  // To the nearest, halves to even.
  const double raw = std::clamp(std::nearbyint(value / field.scale), range.least, range.largest);
  put_raw(bytes, raw < 0.0 ? static_cast<std::uint64_t>(static_cast<std::int64_t>(raw))
                           : static_cast<std::uint64_t>(raw));
}

double get_field(std::span<const std::uint8_t> payload, const WireField& field) {
  if (field.type == WireType::kBit) {
    const std::size_t byte = field.offset / 8u;
    return byte < payload.size() && (payload[byte] >> (field.offset % 8u) & 1u) != 0 ? 1.0 : 0.0;
  }
  const std::uint64_t raw = get_raw(part(payload, field));
  switch (field.type) {
    case WireType::kI8:
      return field.scale * static_cast<std::int8_t>(raw);
    case WireType::kI16:
      return field.scale * static_cast<std::int16_t>(raw);
    case WireType::kI32:
      return field.scale * static_cast<std::int32_t>(raw);
    case WireType::kF32:
      return field.scale *
             static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
    default:
      return field.scale * static_cast<double>(raw);
  }
}

}  // namespace tact::rig
