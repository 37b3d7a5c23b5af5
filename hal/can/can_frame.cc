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

/// Feeds bits in the order of the bus: counts them, the stuff bits among them, and their checksum.
class BitStream {
 public:
  void push(bool bit) RT_SAFE {
    // x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1
    const bool next = bit != (((checksum_ >> 14) & 1u) != 0);
    checksum_ = (checksum_ << 1) & 0x7FFFu;
    if (next) checksum_ ^= 0x4599u;
    put(bit);
  }
  void push(std::uint32_t value, int bits) RT_SAFE {
    for (int i = bits - 1; i >= 0; --i) push(((value >> i) & 1u) != 0);
  }
  void push_checksum() RT_SAFE {
    const std::uint32_t checksum = checksum_;
    for (int i = 14; i >= 0; --i) put(((checksum >> i) & 1u) != 0);
  }
  int count() const RT_SAFE { return count_; }

 private:
  void put(bool bit) RT_SAFE {
    run_ = count_ > 0 && bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    ++count_;
    if (run_ < 5) return;
    last_ = !bit;  // the stuff bit is the first of the next run
    run_ = 1;
    ++count_;
  }

  std::uint32_t checksum_ = 0;
  int count_ = 0;
  int run_ = 0;
  bool last_ = false;
};

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

CanBits can_bits_on_bus(const CanFrame& frame) RT_SAFE {
  constexpr int kHeadBits = 34, kTailBits = 13;
  if (!is_sound(frame)) return {};
  BitStream bits;
  bits.push(false);  // start of frame
  bits.push(frame.id, 11);
  bits.push(frame.rtr);
  bits.push(0u, 2);  // 11-bit identifier; reserved
  bits.push(frame.length, 4);
  for (const std::uint8_t byte : frame.payload()) bits.push(byte, 8);
  bits.push_checksum();
  const int stuffed_bits = kHeadBits + 8 * static_cast<int>(frame.payload().size());
  return {.exact = bits.count() + kTailBits,
          .least = stuffed_bits + kTailBits,
          .most = stuffed_bits + (stuffed_bits - 1) / 4 + kTailBits};
}

}  // namespace tact::hal::can
