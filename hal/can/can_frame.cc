// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_frame.h"

#include <algorithm>

#include "hal/can/little_endian.h"

namespace tact::hal::can {
namespace {

constexpr std::uint32_t kRemoteFlag = 1u << 30;

bool is_sound(const CanFrame& frame) RT_SAFE {
  return frame.id <= kCanLargestId && frame.length <= 8;
}

}  // namespace

std::optional<CanFrameBytes> pack_can_frame(const CanFrame& frame) RT_SAFE {
  if (!is_sound(frame)) return std::nullopt;
  CanFrameBytes bytes{};
  put_unsigned(bytes, 0, 4, frame.id | (frame.rtr ? kRemoteFlag : 0u));
  bytes[4] = frame.length;
  const auto payload = frame.payload();
  std::copy(payload.begin(), payload.end(), bytes.begin() + 8);
  return bytes;
}

std::optional<CanFrame> unpack_can_frame(std::span<const std::uint8_t> bytes) RT_SAFE {
  if (bytes.size() != kCanFrameBytes) return std::nullopt;
  const std::uint32_t word = get_u32(bytes, 0);
  // The flag of an extended or an error frame stays, which makes the identifier too large.
  CanFrame frame{
      .id = word & ~kRemoteFlag, .rtr = (word & kRemoteFlag) != 0, .length = bytes[4], .data = {}};
  if (!is_sound(frame)) return std::nullopt;
  if (!frame.rtr) std::copy_n(bytes.begin() + 8, frame.length, frame.data.begin());
  return frame;
}

}  // namespace tact::hal::can
