// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "hal/falcon/falcon_packets.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::falcon::falcon_stream_test {

using Bytes = std::vector<std::uint8_t>;

FalconReport numbered(int i) {
  return {.counts = {i, -i, 100 * i}, .buttons = static_cast<std::uint8_t>(i & 0xF), .homed = 7};
}
void append(Bytes& bytes, const FalconReport& report, std::size_t size = kFalconPacketSize) {
  const FalconPacket packet = encode(report);
  bytes.insert(bytes.end(), packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
}
std::vector<FalconReport> reports_in(FalconStream& stream, const Bytes& bytes) {
  std::vector<FalconReport> out;
  for (const std::uint8_t byte : bytes)
    if (const auto report = stream.push(byte)) out.push_back(*report);
  return out;
}

TEST(FalconStream, AReportIsThereWithItsLastByte) {
  FalconStream stream;
  const FalconPacket packet = encode(numbered(5));
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_FALSE(stream.push(packet[i]));
    EXPECT_EQ(stream.waiting_bytes(), i + 1);
  }
  EXPECT_EQ(stream.push(packet[15]), numbered(5));
  EXPECT_EQ(stream.waiting_bytes(), 0u);
  EXPECT_EQ(stream.reports(), 1u);
  EXPECT_EQ(stream.dropped_bytes(), 0u);
}

TEST(FalconStream, APacketCutShortCostsItselfOnly) {
  for (std::size_t size = 0; size < kFalconPacketSize; ++size) {
    FalconStream stream;
    Bytes bytes;
    append(bytes, numbered(1));
    append(bytes, numbered(2), size);
    append(bytes, numbered(3));
    EXPECT_EQ(reports_in(stream, bytes), (std::vector{numbered(1), numbered(3)})) << size;
    EXPECT_EQ(stream.dropped_bytes(), size);
  }
}

TEST(FalconStream, AMissingByteMakesNoReportOfTwo) {
  for (std::size_t missing = 0; missing < kFalconPacketSize; ++missing) {
    FalconStream stream;
    Bytes bytes;
    append(bytes, numbered(1));
    bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(missing));
    append(bytes, numbered(2));
    EXPECT_EQ(reports_in(stream, bytes), std::vector{numbered(2)}) << missing;
    EXPECT_EQ(stream.dropped_bytes(), 15u);
  }
}

TEST(FalconStream, BytesBetweenPacketsAreDroppedAndCounted) {
  FalconStream stream;
  Bytes bytes{0x00, 0x3E, 0x41, 0xFF};
  append(bytes, numbered(1));
  bytes.push_back(0x3E);
  append(bytes, numbered(2));
  EXPECT_EQ(reports_in(stream, bytes), (std::vector{numbered(1), numbered(2)}));
  EXPECT_EQ(stream.dropped_bytes(), 5u);
}

TEST(FalconStream, NoiseForEverFillsNothingAndHidesNoReport) {
  FalconStream stream;
  std::mt19937 random(7);
  std::uint64_t pushed = 0;
  for (int i = 0; i < 20'000; ++i) {
    Bytes bytes(random() % 40);
    for (std::uint8_t& byte : bytes) {
      // often bytes of packets, so that noise gets far
      byte = random() % 4 == 0 ? static_cast<std::uint8_t>(random())
                               : static_cast<std::uint8_t>(0x3C + random() % 0x14);
    }
    append(bytes, numbered(i % 300));
    pushed += bytes.size();
    const auto got = reports_in(stream, bytes);
    ASSERT_FALSE(got.empty());
    ASSERT_EQ(got.back(), numbered(i % 300));
    ASSERT_EQ(stream.waiting_bytes(), 0u);
    ASSERT_EQ(stream.reports() * kFalconPacketSize + stream.dropped_bytes(), pushed);
  }
}

TEST(FalconStream, AfterAResetTheOldBeginningIsGone) {
  FalconStream stream;
  Bytes bytes;
  append(bytes, numbered(1), 9);
  (void)reports_in(stream, bytes);
  stream.reset();
  EXPECT_EQ(stream.waiting_bytes(), 0u);
  const FalconPacket packet = encode(numbered(1));
  const Bytes rest(packet.begin() + 9, packet.end());
  EXPECT_TRUE(reports_in(stream, rest).empty());
  EXPECT_EQ(stream.dropped_bytes(), 7u);
}

TEST(FalconStream, LeavesTheHeapAlone) {
  FalconStream stream;
  const FalconPacket packet = encode(numbered(1));
  const tests::NoAlloc guard;
  for (const std::uint8_t byte : packet) (void)stream.push(byte);
  (void)stream.push(0);
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_EQ(stream.reports(), 1u);
}

}  // namespace tact::hal::falcon::falcon_stream_test
