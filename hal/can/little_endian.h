// SPDX-License-Identifier: Apache-2.0
// little_endian.h - numbers in the bytes of a payload, least significant byte first.
//
// The order of SocketCAN on our machines, of ODrive's CANSimple and of CANopen. Written by shifts,
// so the order of the machine does not matter. A place outside the payload is the caller's error:
// the offset is a constant of the message everywhere.
#pragma once

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "model/rt.h"

namespace tact::hal::can {

/// `count` bytes, at most 8, from `offset`.
constexpr std::uint64_t get_unsigned(std::span<const std::uint8_t> bytes, std::size_t offset,
                                     std::size_t count) RT_SAFE {
  assert(count <= 8 && offset + count <= bytes.size());
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)  // bound: 8 (bytes)
    value |= static_cast<std::uint64_t>(bytes[offset + i]) << (8 * i);
  return value;
}

constexpr std::uint16_t get_u16(std::span<const std::uint8_t> bytes, std::size_t offset) RT_SAFE {
  return static_cast<std::uint16_t>(get_unsigned(bytes, offset, 2));
}
constexpr std::uint32_t get_u32(std::span<const std::uint8_t> bytes, std::size_t offset) RT_SAFE {
  return static_cast<std::uint32_t>(get_unsigned(bytes, offset, 4));
}
constexpr std::int16_t get_i16(std::span<const std::uint8_t> bytes, std::size_t offset) RT_SAFE {
  return static_cast<std::int16_t>(get_u16(bytes, offset));
}
constexpr std::int32_t get_i32(std::span<const std::uint8_t> bytes, std::size_t offset) RT_SAFE {
  return static_cast<std::int32_t>(get_u32(bytes, offset));
}
/// IEEE 754 binary32; may be NaN.
constexpr float get_f32(std::span<const std::uint8_t> bytes, std::size_t offset) RT_SAFE {
  return std::bit_cast<float>(get_u32(bytes, offset));
}

/// The low `count` bytes of `value`, to `offset`.
constexpr void put_unsigned(std::span<std::uint8_t> bytes, std::size_t offset, std::size_t count,
                            std::uint64_t value) RT_SAFE {
  assert(count <= 8 && offset + count <= bytes.size());
  for (std::size_t i = 0; i < count; ++i)  // bound: 8 (bytes)
    bytes[offset + i] = static_cast<std::uint8_t>(value >> (8 * i));
}
constexpr void put_f32(std::span<std::uint8_t> bytes, std::size_t offset, float value) RT_SAFE {
  put_unsigned(bytes, offset, 4, std::bit_cast<std::uint32_t>(value));
}

}  // namespace tact::hal::can
