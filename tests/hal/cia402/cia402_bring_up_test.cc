// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_bring_up.h"

#include <gtest/gtest.h>

#include "hal/can/can_settings.h"
#include "hal/cia402/cia402_delta.h"
#include "tests/hal/cia402/cia402_drives.h"
#include "tests/support/can_bench.h"

namespace tact::hal::cia402::cia402_bring_up_test {

using tests::jig_settings;
using tests::published_pose;

struct Bench : tests::CanBench<tests::PlayedCia402s> {
  Bench() : CanBench(jig_settings(published_pose())) {}
  std::string open(double rate_Hz = 1000.0) { return CanBench::open(&start_cia402_delta, rate_Hz); }
  void expect_refused(const std::string& words, double rate_Hz = 1000.0) {
    const std::string message = open(rate_Hz);
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(device, nullptr);
    for (const auto& axis : drives.axis) EXPECT_NE(axis.status, 0x27) << "no power at opening";
  }
};

TEST(Cia402BringUp, WritesEverySettingToEveryDriveAndStartsThem) {
  Bench bench;
  bench.settings.of<Cia402Settings>().command_at_sync = true;
  ASSERT_EQ(bench.open(500.0), "");
  for (auto& axis : bench.drives.axis) {
    const auto node = static_cast<std::uint32_t>(axis.node);
    EXPECT_EQ(axis.written[0x606000], 10u);               // cyclic synchronous torque
    EXPECT_EQ(axis.written[0x101601], 127u << 16 | 20u);  // host's heartbeat, 20 ms
    EXPECT_EQ(axis.written[0x101700], 10u);
    EXPECT_EQ(axis.written[0x600700], 3u);
    EXPECT_EQ(axis.written.count(0x605A00), 1u);
    EXPECT_EQ(axis.written[0x605A00], 0u);  // a quick stop lets go
    EXPECT_EQ(axis.written[0x140001], 0x200u + node);
    EXPECT_EQ(axis.written[0x140002], 1u);
    EXPECT_EQ(axis.written[0x160002], 0x60710010u);
    EXPECT_EQ(axis.written[0x180001], 0x180u + node);
    EXPECT_EQ(axis.written[0x1A0002], 0x60640020u);
    EXPECT_EQ(axis.written[0x60C201], 2u);
    EXPECT_EQ(axis.nmt, NmtState::kOperational);
    EXPECT_EQ(axis.status, 0x40);
    EXPECT_EQ(axis.permille, 0);
  }
  EXPECT_EQ(bench.drives.host_heartbeats, 0) << "the loop's, not ours";
}

TEST(Cia402BringUp, EveryRefusedSettingIsReportedWithItsReason) {
  const auto writes = cst_configuration(1, {});
  for (const SdoWrite& one : *writes) {
    if (one.index == 0x6007 || one.index == 0x60C2) continue;  // reported, not refused
    Bench bench;
    bench.drives.axis[0].refused = static_cast<std::uint32_t>(one.index) << 8 | one.sub;
    bench.drives.axis[0].abort_code = 0x06040041;
    char setting[16];
    std::snprintf(setting, sizeof setting, "0x%04X:%02X", one.index, one.sub);
    bench.expect_refused(std::string("arm 1 (node 1 on can0) refuses setting ") + setting +
                         ": The drive cannot send or take this value every cycle");
  }
}

TEST(Cia402BringUp, SettingsThatNotEveryDriveHasMayBeMissing) {
  for (const std::uint32_t optional : {0x650200u, 0x605A00u, 0x600700u, 0x60C202u}) {
    Bench bench;
    for (auto& axis : bench.drives.axis) axis.refused = optional, axis.abort_code = 0x06020000;
    EXPECT_EQ(bench.open(), "");
  }
}

TEST(Cia402BringUp, NodeGuardingOfAnotherHostIsSwitchedOff) {
  Bench bench;
  for (auto& axis : bench.drives.axis) axis.written = {{0x100C00, 100}, {0x100D00, 3}};
  ASSERT_EQ(bench.open(), "");
  for (auto& axis : bench.drives.axis) {
    EXPECT_EQ(axis.written[0x100C00], 0u);
    EXPECT_EQ(axis.written[0x100D00], 0u);
  }
}

TEST(Cia402BringUp, NodeGuardingMayBeReadOnlyUnlessItStaysOn) {
  Bench half, never, stays;
  for (Bench* bench : {&half, &never, &stays}) {
    bench->drives.axis[1].written = {{0x100C00, 100}, {0x100D00, bench == &never ? 0u : 3u}};
    bench->drives.axis[1].read_only = {0x100C00};
  }
  EXPECT_EQ(half.open(), "");
  EXPECT_EQ(never.open(), "");
  stays.drives.axis[1].read_only = {0x100C00, 0x100D00};
  stays.expect_refused(
      "arm 2 (node 2 on can0) keeps its node guarding on (objects 100C, 100D), which does not go "
      "with heartbeat: set both to 0 with its vendor's program. It refuses setting 0x100D:00");
}

TEST(Cia402BringUp, UnreadableNodeGuardingIsRefusedAsStillOn) {
  Bench bench;
  auto& axis = bench.drives.axis[1];
  axis.written = {{0x100C00, 100}, {0x100D00, 3}};
  axis.read_only = {0x100C00};
  axis.refused = 0x100D00;
  axis.abort_code = 0x08000022;  // "not in this state"
  bench.expect_refused("arm 2 (node 2 on can0) keeps its node guarding on");
}

TEST(Cia402BringUp, ADriveWithoutHeartbeatIsRefusedAndItsGuardingStays) {
  for (const std::uint32_t entry : {0x101700u, 0x101601u}) {
    for (const std::uint32_t abort : {0x06020000u, 0x06090011u}) {
      Bench bench;
      auto& axis = bench.drives.axis[0];
      axis.written = {{0x100C00, 100}, {0x100D00, 3}};
      axis.refused = entry;
      axis.abort_code = abort;
      bench.expect_refused(
          std::string("arm 1 (node 1 on can0) ") +
          (entry == 0x101700 ? "sends no heartbeat (object 1017)"
                             : "does not watch the controller's heartbeat (object 1016)") +
          ", and its node guarding (object 100C) is not used: update its firmware, "
          "or take a drive with heartbeat");
      EXPECT_EQ(axis.written[0x100C00], 100u);
    }
  }
}

TEST(Cia402BringUp, ADriveOfAnotherProfileOrWithoutTorqueModeIsNamed) {
  Bench io, old;
  io.drives.axis[1].device_type = 0x00030191;
  io.expect_refused("arm 2 (node 2 on can0) is no CiA 402 drive (device type 0x00030191)");
  old.drives.axis[2].modes = 0x000000FF;
  old.expect_refused("arm 3 (node 3 on can0) cannot do cyclic synchronous torque");
}

TEST(Cia402BringUp, NamesTheArmThatIsMissing) {
  Bench bench;
  bench.drives.axis[2].powered = false;
  bench.expect_refused("arm 3 (node 3 on can0) does not answer");
}

TEST(Cia402BringUp, NoDriveIsDistinguishedFromWrongBitRateAndNoAcknowledge) {
  Bench silent, unpowered, wrong;
  for (Bench* bench : {&silent, &unpowered, &wrong})
    for (auto& axis : bench->drives.axis) axis.powered = false;
  silent.expect_refused("no drive is heard on can0");
  unpowered.drives.bus.say_error(0x004, 0x20);
  unpowered.expect_refused("no node on can0 acknowledges a frame");
  wrong.drives.bus.say_error(0x040, 0);
  wrong.expect_refused("bit rate");
}

TEST(Cia402BringUp, AnOldFaultIsResetOnceAndOneThatStaysIsReportedInWords) {
  Bench killed, broken;
  for (auto& axis : killed.drives.axis) axis.status = 0x08;
  EXPECT_EQ(killed.open(), "");
  for (const auto& axis : killed.drives.axis) EXPECT_EQ(axis.fault_resets, 1);
  broken.drives.axis[1].status = 0x08;
  broken.drives.axis[1].stuck_fault = true;
  broken.drives.axis[1].error_code = 0x7305;
  broken.expect_refused(
      "arm 2 (node 2 on can0) keeps a fault: The position sensor failed: check the encoder's "
      "cable");
  EXPECT_EQ(broken.drives.axis[1].fault_resets, 1);
}

TEST(Cia402BringUp, TakesPowerFromDrivesThatStillHaveIt) {
  Bench bench;
  for (auto& axis : bench.drives.axis) axis.status = 0x27;
  EXPECT_EQ(bench.open(), "");
  for (const auto& axis : bench.drives.axis) EXPECT_EQ(axis.status, 0x40);
}

TEST(Cia402BringUp, ADriveThatDoesNotStartIsNamed) {
  Bench bench;
  bench.drives.axis[0].says_heartbeat = false;
  bench.expect_refused("arm 1 (node 1 on can0) does not say that it is operational");
}

TEST(Cia402BringUp, ADriveOutOfOperationIsResetOnceAndThenReportsItsError) {
  Bench noted, silent;
  for (Bench* bench : {&noted, &silent}) bench->drives.axis[1].starts = false;
  noted.drives.axis[1].written[0x100301] = 0x1234'8130;
  noted.expect_refused(
      "arm 2 (node 2 on can0) does not become operational and notes an error: The drive missed the "
      "controller's heartbeat");
  silent.expect_refused(
      "arm 2 (node 2 on can0) does not become operational: is a second controller");
  for (Bench* bench : {&noted, &silent}) {
    EXPECT_EQ(bench->drives.axis[0].resets, 0) << "it did start";
    EXPECT_EQ(bench->drives.axis[1].resets, 1);
  }
}

TEST(Cia402BringUp, ATorqueScaleOfZeroIsRefused) {
  Bench bench;
  bench.drives.axis[0].rated = 0;
  bench.expect_refused("has a rated torque of zero");
}

TEST(Cia402BringUp, ArmsAreHomedOrTheReasonIsReported) {
  Bench moving, beyond;
  moving.drives.axis[1].turns_per_s = 1.0;
  moving.expect_refused("arm 2 (node 2 on can0) moves");
  beyond.settings.of<can::CanSettings>().homing = can::Homing::kAbsolute;
  beyond.drives.axis[0].turns = -4.0;
  beyond.expect_refused("the delta is not homed: arm 1 would be at -144 degrees");
}

TEST(Cia402BringUp, NumbersThatCannotWorkAreRefusedAtOnce) {
  Bench fast, uneven, node, index;
  fast.expect_refused("rate_Hz is 2000", 2000.0);
  uneven.expect_refused("rate_Hz is 300", 300.0);
  node.settings.of<can::CanSettings>().node = {1, 2, 127};
  node.expect_refused("a CANopen drive's node is 1 to 126");
  index.settings.of<can::CanSettings>().homing = can::Homing::kIndex;
  index.expect_refused("is for ODrives");
}

TEST(Cia402BringUp, TheCycleOfSevenFramesIs745Bits) { EXPECT_EQ(cia402_cycle_bits(), 745); }

}  // namespace tact::hal::cia402::cia402_bring_up_test
