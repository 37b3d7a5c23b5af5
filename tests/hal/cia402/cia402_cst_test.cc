// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_cst.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <vector>

#include "tests/support/no_alloc.h"

namespace tact::hal::cia402::cia402_cst_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(Cia402Cst, TorqueIsInThousandthsOfTheRatedOne) {
  EXPECT_EQ(cst_torque_permille(0.32, 0.32), 1000);
  EXPECT_EQ(cst_torque_permille(-0.08, 0.32), -250);
  // Halves to even, at a rated torque whose thousandths are exact.
  EXPECT_EQ(cst_torque_permille(2.5, 1000.0), 2);
  EXPECT_EQ(cst_torque_permille(3.5, 1000.0), 4);
  EXPECT_EQ(cst_torque_permille(-2.5, 1000.0), -2);
}

TEST(Cia402Cst, ATorqueTooLargeForItsFieldKeepsItsSign) {
  for (const double torque_Nm : {32.767, 32.768, 33.0, 1e9, 1e308}) {
    EXPECT_EQ(cst_torque_permille(torque_Nm, 1.0), 32767) << torque_Nm;
    EXPECT_LE(*cst_torque_permille(-torque_Nm, 1.0), -32767) << torque_Nm;
  }
  EXPECT_EQ(cst_torque_permille(-40.0, 1.0), -32768);
  EXPECT_EQ(cst_torque_permille(1e308, 1e-308), 32767) << "the quotient is infinite, not none";
}

TEST(Cia402Cst, NonFiniteTorqueOrRatedTorqueIsNeverSent) {
  for (const double bad : {kNan, kInf, -kInf}) {
    EXPECT_FALSE(cst_torque_permille(bad, 1.0));
    EXPECT_FALSE(cst_torque_permille(0.1, bad));
  }
  for (const double rated_torque_Nm : {0.0, -0.0, -1.0}) {
    EXPECT_FALSE(cst_torque_permille(0.1, rated_torque_Nm));
    EXPECT_FALSE(cst_torque_permille(0.0, rated_torque_Nm));
  }
}

TEST(Cia402Cst, NodesThatCannotBeAreNeverAddressedNorBelieved) {
  for (const int node : {-1, 0, 128, 640, std::numeric_limits<int>::min()}) {
    EXPECT_FALSE(cst_command(node, 0x0F, 0)) << node;
    EXPECT_FALSE(cst_configuration(node, {})) << node;
    EXPECT_FALSE(cst_configuration(1, {.host_node = node})) << node;
    can::CanFrame frame = can::make_can_frame(0x180u + static_cast<std::uint32_t>(node), 8);
    EXPECT_FALSE(decode_cst_sample(frame, node)) << node;
  }
}

TEST(Cia402Cst, ASampleIsWholeAndFromItsNode) {
  can::CanFrame sound = can::make_can_frame(0x187, 8);
  sound.data = {0x37, 0x12, 0xFE, 0xFF, 0xFF, 0xFF, 0x18, 0xFC};
  const auto sample = decode_cst_sample(sound, 7);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->statusword, 0x1237);
  EXPECT_EQ(sample->position_increments, -2);
  EXPECT_EQ(sample->torque_permille, -1000);
  for (const int node : {6, 8, 0, -1, 128}) EXPECT_FALSE(decode_cst_sample(sound, node)) << node;
  for (std::uint8_t length = 0; length <= 9; ++length) {
    can::CanFrame frame = sound;
    frame.length = length;
    EXPECT_EQ(decode_cst_sample(frame, 7).has_value(), length == 8) << int{length};
  }
  can::CanFrame remote = sound;
  remote.rtr = true;
  EXPECT_FALSE(decode_cst_sample(remote, 7));
  can::CanFrame command = sound;
  command.id = 0x207;
  EXPECT_FALSE(decode_cst_sample(command, 7));
}

/// What a drive has in its entries after the writes, and what was wrong on the way.
struct FakeDictionary {
  std::map<std::pair<int, int>, std::uint32_t> entry;
  std::vector<int> mapped_while_on;

  void write(const SdoWrite& w) {
    for (const auto& [mapping, message] : {std::pair{0x1600, 0x1400}, {0x1A00, 0x1800}}) {
      const bool on = (entry[{message, 1}] & 0x80000000u) == 0;
      const bool counted = entry[{mapping, 0}] != 0;
      if (w.index == mapping && (on || (w.sub != 0 && counted))) mapped_while_on.push_back(mapping);
    }
    entry[{w.index, w.sub}] = w.value;
  }
};

TEST(Cia402Cst, AMessageIsOffWhileItsMappingChangesAndOnAfterwards) {
  for (const int node : {1, 5, 126}) {
    const auto writes = cst_configuration(node, {});
    ASSERT_TRUE(writes);
    FakeDictionary drive;
    drive.entry[{0x1600, 0}] = 3, drive.entry[{0x1A00, 0}] = 4;  // of the factory, and on
    for (const SdoWrite& write : *writes) {
      EXPECT_TRUE(canopen_sdo_download(node, write)) << write.index;
      drive.write(write);
    }
    EXPECT_TRUE(drive.mapped_while_on.empty());
    const auto n = static_cast<std::uint32_t>(node);
    EXPECT_EQ((drive.entry[{0x1400, 1}]), 0x200 + n);
    EXPECT_EQ((drive.entry[{0x1800, 1}]), 0x180 + n);
    // Lengths of the mappings are those of the frames.
    std::uint32_t command_bits = 0, sample_bits = 0;
    for (int i = 1; i <= 2; ++i) command_bits += drive.entry[{0x1600, i}] & 0xFF;
    for (int i = 1; i <= 3; ++i) sample_bits += drive.entry[{0x1A00, i}] & 0xFF;
    EXPECT_EQ(command_bits, 8u * cst_command(node, 0, 0)->length);
    EXPECT_EQ(sample_bits, 64u);
    EXPECT_EQ((drive.entry[{0x6060, 0}]), 10u);
    EXPECT_EQ((drive.entry[{0x6007, 0}]), 3u);
  }
}

TEST(Cia402Cst, ConfigurationWritesHeartbeatsPeriodAndTransmissionType) {
  const auto writes = cst_configuration(
      2, {.host_node = 100, .host_timeout_ms = 30, .drive_heartbeat_ms = 15, .period_ms = 4});
  ASSERT_TRUE(writes);
  FakeDictionary drive;
  for (const SdoWrite& write : *writes) drive.write(write);
  EXPECT_EQ((drive.entry[{0x1016, 1}]), 100u << 16 | 30u);
  EXPECT_EQ((drive.entry[{0x1017, 0}]), 15u);
  EXPECT_EQ((drive.entry[{0x60C2, 1}]), 4u);
  EXPECT_EQ((drive.entry[{0x1400, 2}]), 255u) << "torque on arrival unless the drive insists";
}

TEST(Cia402Cst, AWatchWithoutATimeIsRefused) {
  // Zero switches a heartbeat off, in silence.
  EXPECT_FALSE(cst_configuration(1, {.host_timeout_ms = 0}));
  EXPECT_FALSE(cst_configuration(1, {.drive_heartbeat_ms = 0}));
  EXPECT_FALSE(cst_configuration(1, {.period_ms = 0}));
  EXPECT_FALSE(cst_configuration(127, {})) << "the host's own node";
}

TEST(Cia402Cst, LeavesTheHeapAlone) {
  const can::CanFrame reply = can::make_can_frame(0x181, 8);
  const tests::NoAlloc guard;
  const auto permille = cst_torque_permille(0.1, 0.32);
  const auto command = cst_command(1, 0x0F, *permille);
  const auto sample = decode_cst_sample(reply, 1);
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(command && sample);
}

}  // namespace tact::hal::cia402::cia402_cst_test
