// SPDX-License-Identifier: Apache-2.0
// wire.h - messages as tables: where a field is, of which type, in which step. Little endian.
//
//     value = raw x scale        raw: unsigned, two's complement or IEEE 754 binary32
//
// A table is the whole knowledge of a message: both directions read it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tact::rig {

enum class WireType : std::uint8_t { kU8, kU16, kU32, kU64, kI8, kI16, kI32, kF32, kBit };

struct WireField {
  std::string_view name;
  std::uint8_t offset;  // bytes; of a bit: 8 x byte + bit
  WireType type;
  double scale = 1.0;
};

constexpr std::size_t wire_size(WireType type) {
  switch (type) {
    case WireType::kU16:
    case WireType::kI16:
      return 2;
    case WireType::kU32:
    case WireType::kI32:
    case WireType::kF32:
      return 4;
    case WireType::kU64:
      return 8;
    default:
      return 1;
  }
}

/// Put one field into the payload, rounded to its step and held in its range; what does not fit
/// into the payload is left out. `value` is finite unless the field is a float.
void put_field(std::span<std::uint8_t> payload, const WireField& field, double value);
/// One field of the payload; beyond its end there are zeros.
double get_field(std::span<const std::uint8_t> payload, const WireField& field);

/// Little endian integers of up to eight bytes.
void put_raw(std::span<std::uint8_t> bytes, std::uint64_t raw);
std::uint64_t get_raw(std::span<const std::uint8_t> bytes);

}  // namespace tact::rig
