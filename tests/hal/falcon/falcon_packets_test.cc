// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_packets.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/support/no_alloc.h"

namespace tact::hal::falcon::falcon_packets_test {

FalconPacket changed(FalconPacket packet, std::size_t place, std::uint8_t byte) {
  packet[place] = byte;
  return packet;
}

TEST(FalconPackets, MatchPenAndPaper) {
  // 4095 = 0x0FFF: nibbles F F F 0 from the least one, 50 50 50 41; 3906 = 0x0F42: 43 45 50 41;
  // 4034 = 0x0FC2: 43 4D 50 41; blue is 4: 45. Both packets were captured from the vendor's driver.
  const FalconPacket captured{0x3c, 0x50, 0x50, 0x50, 0x41, 0x43, 0x45, 0x50,
                              0x41, 0x43, 0x4d, 0x50, 0x41, 0x45, 0x41, 0x3e};
  const FalconCommand command{.motor = {4095, 3906, 4034}, .lights = kFalconBlue, .homing = false};
  EXPECT_EQ(encode(command), captured);
  EXPECT_EQ(decode_falcon_command(captured), command);

  // -2900 = 0xF4AC: 4D 4B 45 50; 27 = 0x001B: 4C 42 41 41; 929 = 0x03A1: 42 4B 44 41
  const FalconPacket negative{0x3c, 0x4d, 0x4b, 0x45, 0x50, 0x4c, 0x42, 0x41,
                              0x41, 0x42, 0x4b, 0x44, 0x41, 0x45, 0x41, 0x3e};
  const FalconCommand mixed{.motor = {-2900, 27, 929}, .lights = kFalconBlue, .homing = false};
  EXPECT_EQ(encode(mixed), negative);
  EXPECT_EQ(decode_falcon_command(negative), mixed);
}

TEST(FalconPackets, EveryCountButtonAndHomedBitComesBack) {
  for (int count = -32768; count <= 32767; ++count) {
    const FalconReport report{.counts = {count, -1 - count, 7},
                              .buttons = static_cast<std::uint8_t>(count & 0xF),
                              .homed = static_cast<std::uint8_t>(count >> 4 & 0x7)};
    ASSERT_EQ(decode_falcon_report(encode(report)), report) << count;
  }
}

TEST(FalconPackets, EveryMotorWordOutOfTheRangeIsClamped) {
  const int most = std::numeric_limits<int>::max(), least = std::numeric_limits<int>::min();
  for (int word = -4095; word <= 4095; ++word) {
    const FalconCommand command{.motor = {word, 0, -word}, .lights = kFalconRed};
    ASSERT_EQ(decode_falcon_command(encode(command)), command) << word;
  }
  const auto clamped = decode_falcon_command(encode(FalconCommand{.motor = {most, least, 4096}}));
  ASSERT_TRUE(clamped);
  EXPECT_EQ(clamped->motor, (FalconWords{4095, -4095, 4095}));
}

TEST(FalconPackets, AnExtraLightBitAsksForNoHoming) {
  const auto sent = decode_falcon_command(encode(FalconCommand{.lights = 0xFF, .homing = false}));
  ASSERT_TRUE(sent);
  EXPECT_FALSE(sent->homing);
  EXPECT_EQ(sent->lights, kFalconLights);
}

TEST(FalconPackets, RequestsTooLargeKeepTheirDirection) {
  // 8190 is twice the range: all are halved
  EXPECT_EQ(falcon_motor_words({8190.0, -4095.0, 100.0}), (FalconWords{4095, -2048, 50}));
  EXPECT_EQ(falcon_motor_words({4095.0, -4095.0, 0.4}), (FalconWords{4095, -4095, 0}));
  EXPECT_EQ(falcon_motor_words({1e300, -1e300, 0.0}), (FalconWords{4095, -4095, 0}));
}

TEST(FalconPackets, ARequestThatIsNoNumberMovesNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    EXPECT_EQ(falcon_motor_words({bad, 100.0, 100.0}), FalconWords{});
    EXPECT_EQ(falcon_motor_words({100.0, 100.0, bad}), FalconWords{});
  }
}

TEST(FalconPackets, OnlyOneWholePacketIsRead) {
  const FalconPacket whole = encode(FalconReport{.counts = {1, 2, 3}, .homed = 7});
  std::vector<std::uint8_t> bytes(whole.begin(), whole.end());
  bytes.insert(bytes.end(), whole.begin(), whole.end());
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    const auto part = std::span(bytes).first(size);
    EXPECT_EQ(decode_falcon_report(part).has_value(), size == 16) << size;
    const FalconPacket command = encode(FalconCommand{});
    EXPECT_FALSE(size < 16 && decode_falcon_command(std::span(command).first(size)));
  }
}

TEST(FalconPackets, EveryByteOutOfItsRangeIsDamage) {
  const FalconPacket good = encode(FalconReport{.counts = {1, -2, 3}, .buttons = 5, .homed = 7});
  for (std::size_t place = 0; place < good.size(); ++place) {
    for (int byte = 0; byte <= 0xFF; ++byte) {
      bool fits = byte >= 0x41 && byte <= 0x50;  // a nibble
      if (place == 0) fits = byte == 0x3C;
      if (place == 13) fits = byte >= 0x41 && byte <= 0xC0;
      if (place == 14) fits = byte != 0x3C && byte != 0x3E;
      if (place == 15) fits = byte == 0x3E;
      const FalconPacket packet = changed(good, place, static_cast<std::uint8_t>(byte));
      EXPECT_EQ(decode_falcon_report(packet).has_value(), fits) << place << " " << byte;
    }
  }
}

TEST(FalconPackets, ACommandThatNoDriverMaySendIsDamage) {
  const FalconPacket good = encode(FalconCommand{.motor = {4095, 0, -4095}});
  EXPECT_TRUE(decode_falcon_command(good));
  EXPECT_FALSE(decode_falcon_command(changed(good, 13, 0x51)));  // a bit that no command has
  // 4095 -> 0x1FFF = 8191, beyond what motors are sent; -4095 = 0xF001 -> 0xF000 = -4096
  EXPECT_FALSE(decode_falcon_command(changed(good, 4, 0x42)));
  EXPECT_FALSE(decode_falcon_command(changed(good, 9, 0x41)));
}

TEST(FalconPackets, OnlyThreeHomedAxesAreHomed) {
  for (std::uint8_t homed = 0; homed < 7; ++homed)
    EXPECT_FALSE(FalconReport{.homed = homed}.all_homed());
  EXPECT_TRUE(FalconReport{.homed = 7}.all_homed());
}

TEST(FalconPackets, LeaveTheHeapAlone) {
  const tests::NoAlloc guard;
  const FalconCommand command{.motor = falcon_motor_words({1.0, 2.0, 9e9})};
  (void)decode_falcon_command(encode(command));
  (void)decode_falcon_report(encode(FalconReport{}));
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::falcon::falcon_packets_test
