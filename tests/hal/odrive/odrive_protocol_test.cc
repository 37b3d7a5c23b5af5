// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_protocol.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "hal/can/little_endian.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::odrive::odrive_protocol_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfF = std::numeric_limits<float>::infinity();

can::CanFrame reply(int node, OdriveCommand command) {
  return can::make_can_frame(
      static_cast<std::uint32_t>(node << 5) | static_cast<std::uint32_t>(command), 8);
}
can::CanFrame reply(int node, OdriveCommand command, float first, float second) {
  can::CanFrame frame = reply(node, command);
  can::put_f32(frame.data, 0, first);
  can::put_f32(frame.data, 4, second);
  return frame;
}

/// Every encoder with sound numbers, but for the node and one number, which goes everywhere.
std::vector<std::optional<can::CanFrame>> all_encoded(int node, double value) {
  return {odrive_input_torque(node, value, OdriveTorqueLength::kShort),
          odrive_input_torque(node, value, OdriveTorqueLength::kPadded),
          odrive_limits(node, value, 1.0), odrive_limits(node, 1.0, value)};
}
std::vector<std::optional<can::CanFrame>> all_plain(int node) {
  return {odrive_axis_state(node, OdriveAxisState::kClosedLoop),
          odrive_controller_mode(node, OdriveControlMode::kTorque, OdriveInputMode::kPassThrough),
          odrive_estop(node), odrive_clear_errors(node, true),
          odrive_request(node, OdriveCommand::kGetVersion)};
}

TEST(OdriveProtocol, ATorqueIsFourBytesOnTheWire) {
  // 0.5 = 0x3F000000; node 3, command 14: 3 * 32 + 14 = 110.
  const auto frame = odrive_input_torque(3, 0.5, OdriveTorqueLength::kShort);
  EXPECT_EQ(frame, (can::CanFrame{.id = 110, .rtr = false, .length = 4, .data = {0, 0, 0, 0x3F}}));
}

TEST(OdriveProtocol, ANodeOutsideTheIdentifierIsNeverAddressed) {
  for (const int node : {-1, 64, 65, 1 << 20, std::numeric_limits<int>::min()}) {
    for (const auto& frame : all_encoded(node, 0.1)) EXPECT_FALSE(frame) << node;
    for (const auto& frame : all_plain(node)) EXPECT_FALSE(frame) << node;
  }
  for (const int node : {0, 63}) {
    for (const auto& frame : all_encoded(node, 0.1)) {
      ASSERT_TRUE(frame);
      EXPECT_EQ(odrive_address(*frame).node, node);
    }
    for (const auto& frame : all_plain(node)) {
      ASSERT_TRUE(frame);
      EXPECT_EQ(odrive_address(*frame).node, node);
    }
  }
}

TEST(OdriveProtocol, NonFiniteOrTooLargeNumberIsNeverSent) {
  for (const double value : {kNan, kInf, -kInf, 3.5e38, -3.5e38, 1e300})
    for (const auto& frame : all_encoded(5, value)) EXPECT_FALSE(frame) << value;
  EXPECT_TRUE(odrive_input_torque(5, 3.4e38, OdriveTorqueLength::kShort));
}

TEST(OdriveProtocol, LimitsAreNotNegative) {
  EXPECT_FALSE(odrive_limits(5, -0.1, 1.0));
  EXPECT_FALSE(odrive_limits(5, 1.0, -0.1));
  EXPECT_TRUE(odrive_limits(5, 0.0, 0.0));
}

TEST(OdriveProtocol, ARequestIsRemoteAndAsksForEightBytes) {
  const auto frame = odrive_request(2, OdriveCommand::kGetEncoderEstimates);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->rtr);
  EXPECT_EQ(frame->length, 8);
  EXPECT_EQ(frame->id, 2u << 5 | 9u);
  EXPECT_FALSE(decode_odrive_estimates(*frame, 2)) << "a request is no reply";
}

TEST(OdriveProtocol, EveryReplyComesFromItsNodeItsMessageAndInFull) {
  const auto check = [](const char* name, auto decode, OdriveCommand command) {
    const can::CanFrame sound = reply(7, command);
    EXPECT_TRUE(decode(sound, 7)) << name;
    for (const int node : {6, 8, 0, -1, 64, 71}) EXPECT_FALSE(decode(sound, node)) << name << node;
    for (std::uint8_t length = 0; length <= 9; ++length) {
      can::CanFrame frame = sound;
      frame.length = length;
      EXPECT_EQ(decode(frame, 7).has_value(), length == 8) << name << int{length};
    }
    for (std::uint32_t other = 0; other < 32; ++other) {
      can::CanFrame frame = sound;
      frame.id = 7u << 5 | other;
      EXPECT_EQ(decode(frame, 7).has_value(), other == static_cast<std::uint32_t>(command)) << name;
    }
    can::CanFrame remote = sound;
    remote.rtr = true;
    EXPECT_FALSE(decode(remote, 7)) << name;
    can::CanFrame wide = sound;
    wide.id |= 0x800;
    EXPECT_FALSE(decode(wide, 7)) << name;
    EXPECT_FALSE(decode(wide, 64 + 7)) << name;
  };
  check("version", decode_odrive_version, OdriveCommand::kGetVersion);
  check("heartbeat", decode_odrive_heartbeat, OdriveCommand::kHeartbeat);
  check("heartbeat 0.5", decode_odrive_heartbeat_05, OdriveCommand::kHeartbeat);
  check("estimates", decode_odrive_estimates, OdriveCommand::kGetEncoderEstimates);
}

TEST(OdriveProtocol, NonFiniteEstimateIsRefused) {
  const auto check = [](const char* name, auto decode, OdriveCommand command) {
    EXPECT_TRUE(decode(reply(7, command, 1.0f, -2.0f), 7)) << name;
    for (const float bad : {kNanF, kInfF, -kInfF}) {
      EXPECT_FALSE(decode(reply(7, command, bad, 1.0f), 7)) << name;
      EXPECT_FALSE(decode(reply(7, command, 1.0f, bad), 7)) << name;
    }
  };
  check("estimates", decode_odrive_estimates, OdriveCommand::kGetEncoderEstimates);
}

TEST(OdriveProtocol, TheVersionReportsItsFirmware) {
  can::CanFrame frame = reply(1, OdriveCommand::kGetVersion);
  frame.data = {2, 4, 5, 58, 0, 6, 10, 1};
  const auto version = decode_odrive_version(frame, 1);
  ASSERT_TRUE(version);
  EXPECT_EQ(version->firmware_major, 0);
  EXPECT_EQ(version->firmware_minor, 6);
}

TEST(OdriveProtocol, AnOldHeartbeatTakesEveryBitOfAPartForAnError) {
  const auto read = [](std::uint8_t motor, std::uint8_t encoder, std::uint8_t controller) {
    can::CanFrame frame = reply(1, OdriveCommand::kHeartbeat);
    frame.data[5] = motor, frame.data[6] = encoder, frame.data[7] = controller;
    return *decode_odrive_heartbeat_05(frame, 1);
  };
  for (int bit = 0; bit < 8; ++bit) {
    const auto one = static_cast<std::uint8_t>(1 << bit);
    EXPECT_TRUE(read(one, 0, 0).motor_error);
    EXPECT_FALSE(read(one, 0, 0).encoder_error);
    EXPECT_TRUE(read(0, one, 0).encoder_error);
    EXPECT_EQ(read(0, 0, one).controller_error, bit < 7);
    EXPECT_EQ(read(0, 0, one).trajectory_done, bit == 7);
  }
}

TEST(OdriveProtocol, AnOldDriveReportsItsEncodersCount) {
  can::CanFrame frame = can::make_can_frame(7u << 5 | 0x0A, 8);
  frame.data = {0xFE, 0xFF, 0xFF, 0xFF, 0xFE, 0x1F, 0, 0};
  const auto count = decode_odrive_count_05(frame, 7);
  ASSERT_TRUE(count);
  EXPECT_EQ(count->shadow, -2);
  EXPECT_FALSE(decode_odrive_count_05(frame, 6));
}

TEST(OdriveProtocol, LeavesTheHeapAlone) {
  const can::CanFrame estimates = reply(7, OdriveCommand::kGetEncoderEstimates, 1.0f, 2.0f);
  const tests::NoAlloc guard;
  const auto torque = odrive_input_torque(7, 0.1, OdriveTorqueLength::kShort);
  const auto got = decode_odrive_estimates(estimates, 7);
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(torque && got);
}

}  // namespace tact::hal::odrive::odrive_protocol_test
