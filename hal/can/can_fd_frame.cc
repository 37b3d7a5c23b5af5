// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_fd_frame.h"

#include <algorithm>

#include "hal/can/little_endian.h"

namespace tact::hal::can {
namespace {

constexpr std::uint32_t kMaxShortId = 0x7FF;
constexpr std::uint32_t kExtendedFlag = 1u << 31;
constexpr std::uint8_t kBitRateSwitch = 1, kFdFrame = 4;
constexpr std::array<std::uint8_t, 16> kLengths{0, 1,  2,  3,  4,  5,  6,  7,
                                                8, 12, 16, 20, 24, 32, 48, 64};

bool is_sound(const CanFdFrame& frame) RT_SAFE {
  return frame.id <= kCanFdLargestId && can_fd_length(frame.length) == frame.length;
}

}  // namespace

std::optional<std::uint8_t> can_fd_length(std::size_t bytes) RT_SAFE {
  for (const std::uint8_t one : kLengths)
    if (bytes <= one) return one;
  return std::nullopt;
}

std::optional<CanFdFrameBytes> pack_can_frame(const CanFdFrame& frame) RT_SAFE {
  if (!is_sound(frame)) return std::nullopt;
  CanFdFrameBytes bytes{};
  put_unsigned(bytes, 0, 4, frame.id | (frame.id > kMaxShortId ? kExtendedFlag : 0u));
  bytes[4] = frame.length;
  bytes[5] = kBitRateSwitch | kFdFrame;
  const auto payload = frame.payload();
  std::copy(payload.begin(), payload.end(), bytes.begin() + 8);
  return bytes;
}

std::optional<CanFdFrame> unpack_can_fd_frame(std::span<const std::uint8_t> bytes) RT_SAFE {
  if (bytes.size() != kCanFdFrameBytes) return std::nullopt;
  const std::uint32_t word = get_u32(bytes, 0);
  const bool extended = (word & kExtendedFlag) != 0;
  // The flag of a request or an error frame stays, which makes the identifier too large.
  CanFdFrame frame{.id = word & ~kExtendedFlag, .length = bytes[4], .data = {}};
  if (!is_sound(frame) || (!extended && frame.id > kMaxShortId)) return std::nullopt;
  std::copy_n(bytes.begin() + 8, frame.length, frame.data.begin());
  return frame;
}

CanFdBits most_can_fd_bits(const CanFdFrame& frame) RT_SAFE {
  if (!is_sound(frame)) return {};
  // Start, identifier, flags; a stuff bit after every fourth. Then delimiter, acknowledge, 7 end of
  // frame, 3 intermission.
  const int head = frame.id > kMaxShortId ? 36 : 17;
  const int slow = head + (head - 1) / 4 + 13;
  // State and length, data; then the count of stuff bits and the checksum, with fixed stuff bits.
  const int stuffed = 5 + 8 * frame.length;
  const int tail = frame.length <= 16 ? 4 + 17 + 6 : 4 + 21 + 7;
  return {.slow = slow, .fast = stuffed + stuffed / 4 + tail};
}

}  // namespace tact::hal::can
