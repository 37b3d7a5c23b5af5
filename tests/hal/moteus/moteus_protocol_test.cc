// SPDX-License-Identifier: Apache-2.0
// The published frames are compared by tact-verify; here is what a sound drive never sends.
#include "hal/moteus/moteus_protocol.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tact::hal::moteus::moteus_protocol_test {

using can::CanFdFrame;

CanFdFrame reply_of(int node, const std::vector<std::uint8_t>& bytes) {
  CanFdFrame frame{
      .id = moteus_reply_id(node), .length = static_cast<std::uint8_t>(bytes.size()), .data = {}};
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  return frame;
}

TEST(MoteusProtocol, NonFiniteTorqueBadWatchdogOrNodeIsNotSent) {
  EXPECT_TRUE(moteus_torque(1, -0.3, 0.01));
  for (const double torque_Nm : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e39})
    EXPECT_FALSE(moteus_torque(1, torque_Nm, 0.01)) << torque_Nm;
  for (const double watchdog_s : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_FALSE(moteus_torque(1, 0.1, watchdog_s)) << "0 is the drive's own, none is endless";
  for (const int node : {-1, 0, 127, 128, 0x8001}) {
    EXPECT_FALSE(moteus_torque(node, 0.1, 0.01)) << node;
    EXPECT_FALSE(moteus_stop(node)) << node;
    EXPECT_FALSE(moteus_ask(node)) << node;
  }
}

TEST(MoteusProtocol, QuestionsWriteNothing) {
  EXPECT_EQ(moteus_ask(1)->data[0] & 0xF0, 0x10);
  EXPECT_EQ(moteus_ask_kind(1)->data[0] & 0xF0, 0x10);
  // int8 from 0x00C, int32 from 0x102 as a varuint of two bytes
  const std::vector<std::uint8_t> bytes{0x11, 0x0C, 0x19, 0x82, 0x02};
  EXPECT_TRUE(std::ranges::equal(moteus_ask_kind(1)->payload(), bytes));
}

TEST(MoteusProtocol, AReplyIsReadByNodeAndDirection) {
  const CanFdFrame frame = reply_of(5, {0x21, 0x00, 0x0A});
  ASSERT_TRUE(decode_moteus(frame, 5));
  EXPECT_EQ(decode_moteus(frame, 5)->mode, 10);
  EXPECT_FALSE(decode_moteus(frame, 4));
  CanFdFrame question = frame;
  question.id = 0x8005;
  EXPECT_FALSE(decode_moteus(question, 5));
  question.id = 5u << 8 | 3;  // to another host
  EXPECT_FALSE(decode_moteus(question, 5));
  EXPECT_EQ(moteus_address(frame).source, 5);
}

TEST(MoteusProtocol, AFrameThatIsCutAnywhereGivesNothingThatItDoesNotHold) {
  const std::vector<std::uint8_t> whole{0x21, 0x00, 0x0A, 0x2F, 0x01, 0,   0, 0x80,
                                        0x3F, 0,    0,    0,    0x40, 0,   0, 0x40,
                                        0x40, 0x23, 0x0D, 0x30, 0x1E, 0x00};
  const auto all = decode_moteus(reply_of(1, whole), 1);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->position_turns, 1.0);
  EXPECT_EQ(all->velocity_turns_per_s, 2.0);
  EXPECT_EQ(all->torque_Nm, 3.0);
  EXPECT_EQ(all->voltage_V, 24.0);
  EXPECT_EQ(all->temperature_C, 30.0);
  EXPECT_EQ(all->fault, 0);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto cut = decode_moteus(
        reply_of(1, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}), 1);
    const bool at_a_border = size == 0 || size == 3 || size == 17;
    EXPECT_EQ(cut.has_value(), at_a_border) << size;
    if (cut) EXPECT_FALSE(cut->fault) << size;
  }
}

TEST(MoteusProtocol, UnknownValueOfADriveIsReadAsMissing) {
  const auto reply = decode_moteus(
      reply_of(1, {0x21, 0x00, 0x80, 0x2D, 0x01, 0, 0, 0xC0, 0x7F, 0x21, 0x0D, 0x80}), 1);
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->mode);
  EXPECT_FALSE(reply->position_turns);
  EXPECT_FALSE(reply->voltage_V);
}

TEST(MoteusProtocol, ARegisterInAnotherTypeIsNotTheOneThatWasAskedFor) {
  // Mode as a float, position as int16, the register map as int8.
  const auto reply = decode_moteus(
      reply_of(1, {0x2D, 0x00, 0, 0, 0x20, 0x41, 0x25, 0x01, 0x10, 0x00, 0x21, 0x82, 0x02, 0x05}),
      1);
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->mode);
  EXPECT_FALSE(reply->position_turns);
  EXPECT_FALSE(reply->register_map);
}

TEST(MoteusProtocol, ARefusedRegisterIsReported) {
  const auto reply = decode_moteus(reply_of(1, {0x31, 0x82, 0x02, 0x01, 0x50, 0x50}), 1);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->refused_register, 0x102);
}

TEST(MoteusProtocol, CountsBeyondTheFrameAndForeignKindsAreNoReply) {
  EXPECT_FALSE(decode_moteus(reply_of(1, {0x20, 0xFF, 0xFF, 0xFF, 0xFF, 0x0F, 0x00, 1, 2}), 1));
  EXPECT_FALSE(decode_moteus(reply_of(1, {0x20, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01, 0x00}), 1));
  EXPECT_FALSE(decode_moteus(reply_of(1, {0x40, 0x01, 0x02}), 1));  // a tunnel of characters
  EXPECT_FALSE(decode_moteus(reply_of(1, {0x01, 0x00, 0x0A}), 1));  // a command
  // A register far above is not the mode again.
  const auto high = decode_moteus(reply_of(1, {0x21, 0x80, 0x80, 0x04, 0x0A}), 1);
  ASSERT_TRUE(high);
  EXPECT_FALSE(high->mode);
}

}  // namespace tact::hal::moteus::moteus_protocol_test
