// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "hal/can/little_endian.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::can::can_frame_test {

constexpr CanFrame kTorque{.id = 0x06E, .length = 4, .data = {0xAC, 0xAD, 0x58, 0xBE}};

TEST(CanFrame, HasTheBytesOfTheKernel) {
  const auto bytes = pack_can_frame(kTorque);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(*bytes, (CanFrameBytes{0x6E, 0, 0, 0, 4, 0, 0, 0, 0xAC, 0xAD, 0x58, 0xBE, 0, 0, 0, 0}));
}

TEST(CanFrame, PackingUndoesUnpackingForEveryIdentifierAndLength) {
  for (std::uint32_t id = 0; id <= kCanLargestId; ++id) {
    for (std::uint8_t length = 0; length <= 8; ++length) {
      for (const bool rtr : {false, true}) {
        CanFrame frame{.id = id, .rtr = rtr, .length = length, .data = {}};
        if (!rtr) std::fill_n(frame.data.begin(), length, std::uint8_t{0xA5});
        const auto bytes = pack_can_frame(frame);
        ASSERT_TRUE(bytes);
        ASSERT_EQ(unpack_can_frame(*bytes), frame);
      }
    }
  }
}

TEST(CanFrame, IdentifiersAbove7FFAndLengthsAbove8AreRefused) {
  CanFrame frame = kTorque;
  frame.id = 0x800;
  EXPECT_FALSE(pack_can_frame(frame));
  frame = kTorque;
  frame.length = 9;
  EXPECT_FALSE(pack_can_frame(frame));
  EXPECT_TRUE(frame.payload().empty());
}

TEST(CanFrame, DamagedBytesAreNoFrame) {
  const CanFrameBytes sound = *pack_can_frame(kTorque);
  for (const std::size_t size : {0u, 1u, 8u, 15u})
    EXPECT_FALSE(unpack_can_frame(std::span(sound).first(size))) << size;
  std::vector<std::uint8_t> longer(sound.begin(), sound.end());
  longer.push_back(0);
  EXPECT_FALSE(unpack_can_frame(longer));
  const auto with = [&](std::size_t at, std::uint8_t value) {
    CanFrameBytes bytes = sound;
    bytes[at] = value;
    return unpack_can_frame(bytes);
  };
  ASSERT_TRUE(with(0, 0x6E));
  EXPECT_FALSE(with(3, 0x80)) << "an extended identifier is another one with the same low bits";
  EXPECT_FALSE(with(3, 0x20)) << "an error frame is no message";
  EXPECT_FALSE(with(1, 0x08)) << "an identifier above 11 bits";
  EXPECT_FALSE(with(3, 0x10)) << "an identifier above 11 bits";
  EXPECT_FALSE(with(4, 9)) << "more data than a frame holds";
  EXPECT_FALSE(with(4, 0xFF));
}

TEST(CanFrame, BytesBeyondTheLengthAreNotBelieved) {
  CanFrameBytes bytes = *pack_can_frame(kTorque);
  std::fill(bytes.begin() + 12, bytes.end(), std::uint8_t{0xEE});
  EXPECT_EQ(unpack_can_frame(bytes), kTorque);
  bytes[3] = 0x40;  // a remote request has a length, and no data at all
  const auto request = unpack_can_frame(bytes);
  ASSERT_TRUE(request);
  EXPECT_TRUE(request->rtr);
  EXPECT_EQ(request->length, 4);
  EXPECT_TRUE(request->payload().empty());
  EXPECT_EQ(request->data, (std::array<std::uint8_t, 8>{}));
  // And what a sender left there does not reach the bus.
  CanFrame dirty = kTorque;
  dirty.data[7] = 0xEE;
  EXPECT_EQ(pack_can_frame(dirty), pack_can_frame(kTorque));
}

/// Bits of this very frame: a row of bits, its remainder by division, then the stuffing.
int bits_on_the_bus(const CanFrame& frame) {
  std::vector<int> bits{0};
  const auto append = [&bits](unsigned value, int count) {
    while (count-- > 0) bits.push_back(static_cast<int>(value >> count & 1u));
  };
  append(frame.id, 11);
  append(frame.rtr ? 4 : 0, 3);
  append(frame.length, 4);
  for (int i = 0; i < (frame.rtr ? 0 : frame.length); ++i)
    append(frame.data[static_cast<std::size_t>(i)], 8);
  std::vector<int> rest = bits;
  rest.resize(bits.size() + 15);
  const std::vector<int> divisor{1, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};  // 2^15 + 0x4599
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (rest[i] == 0) continue;
    for (std::size_t j = 0; j < divisor.size(); ++j) rest[i + j] ^= divisor[j];
  }
  bits.insert(bits.end(), rest.end() - 15, rest.end());
  std::vector<int> wire;
  for (const int bit : bits) {
    wire.push_back(bit);
    if (wire.size() >= 5 &&
        std::all_of(wire.end() - 5, wire.end(), [&](int b) { return b == bit; }))
      wire.push_back(1 - bit);
  }
  return static_cast<int>(wire.size()) + 13;
}

TEST(CanFrame, NoFrameCostsMoreThanTheBudgetHasForIt) {
  EXPECT_EQ(most_can_bits(0), 55);
  EXPECT_EQ(most_can_bits(4), 95);
  EXPECT_EQ(most_can_bits(8), 135);
  // Identifier 0 without data: 34 zeros, the checksum of zeros is zero. A one after the first five,
  // which starts the next run; then a one after every five zeros: floor(34 / 5) = 6 stuff bits.
  EXPECT_EQ(bits_on_the_bus(make_can_frame(0, 0)), 47 + 6);
  unsigned seed = 1;
  for (int i = 0; i < 3000; ++i) {
    const auto next = [&seed] { return (seed = seed * 1664525u + 1013904223u) >> 16; };
    CanFrame frame = make_can_frame(next() & kCanLargestId, static_cast<std::uint8_t>(next() % 9));
    frame.rtr = next() % 8 == 0;
    for (std::uint8_t& byte : frame.data)
      byte = static_cast<std::uint8_t>(next() % 3 == 0 ? next() : next() % 2 * 0xF0u);
    ASSERT_LE(bits_on_the_bus(frame), most_can_bits(frame.rtr ? 0 : frame.length)) << i;
  }
}

TEST(CanFrame, LeavesTheHeapAlone) {
  const tests::NoAlloc guard;
  const auto bytes = pack_can_frame(kTorque);
  const auto frame = unpack_can_frame(*bytes);
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(frame);
}

TEST(LittleEndian, TheLeastByteComesFirstAndSignsSurvive) {
  const std::array<std::uint8_t, 8> bytes{0x01, 0x02, 0x03, 0x84, 0x00, 0x00, 0x80, 0xBF};
  EXPECT_EQ(get_u16(bytes, 0), 0x0201);
  EXPECT_EQ(get_u32(bytes, 0), 0x84030201u);
  EXPECT_EQ(get_i32(bytes, 0), -0x7BFCFDFF);
  EXPECT_EQ(get_i16(bytes, 2), -0x7BFD);
  EXPECT_EQ(get_f32(bytes, 4), -1.0f);
  EXPECT_EQ(get_unsigned(bytes, 0, 8), 0xBF80000084030201u);
  std::array<std::uint8_t, 8> out{};
  put_unsigned(out, 0, 4, 0x84030201u);
  put_f32(out, 4, -1.0f);
  EXPECT_EQ(out, bytes);
}

}  // namespace tact::hal::can::can_frame_test
