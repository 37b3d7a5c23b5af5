// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_bring_up.h"

#include <gtest/gtest.h>

#include "hal/can/can_settings.h"
#include "hal/lines_settings.h"
#include "hal/odrive/odrive_delta.h"
#include "tests/hal/odrive/odrive_drives.h"
#include "tests/support/can_bench.h"

namespace tact::hal::odrive::odrive_bring_up_test {

using tests::jig_settings;
using tests::published_pose;
using enum OdriveCommand;

struct Bench : tests::CanBench<tests::PlayedOdrives> {
  Bench() : CanBench(jig_settings(published_pose())) {}
  std::string open(double rate_Hz = 1000.0) { return CanBench::open(&start_odrive_delta, rate_Hz); }
  void expect_refused(const std::string& words) {
    const std::string message = open();
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(device, nullptr);
    for (const auto& axis : drives.axis) EXPECT_NE(axis.state, 8u) << "no power at opening";
  }
};

TEST(OdriveBringUp, SetsTorqueModeAndLimitsOnAllThreeWithoutPower) {
  Bench bench;
  bench.settings.of<OdriveSettings>().max_current_A = 12.5;
  bench.settings.of<OdriveSettings>().max_velocity_turns_per_s = 42.0;
  ASSERT_EQ(bench.open(), "");
  for (const auto& axis : bench.drives.axis) {
    EXPECT_EQ(axis.control, 1u);
    EXPECT_EQ(axis.input, 1u);
    EXPECT_EQ(axis.limit_A, 12.5f);
    EXPECT_EQ(axis.limit_turns_per_s, 42.0f);
    EXPECT_EQ(axis.state, 1u);
    EXPECT_EQ(axis.torque_Nm, 0.0f);
  }
  EXPECT_LT(bench.drives.time_ms, 1500);
}

TEST(OdriveBringUp, LeavesTheDrivesOwnLimitsUnlessTheSceneNamesOthers) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(bench.drives.times(i, OdriveCommand::kSetLimits), 0);
    EXPECT_EQ(bench.drives.times(i, OdriveCommand::kSetControllerMode), 1);
  }
}

TEST(OdriveBringUp, FindsTheGenerationByTheReportedVersion) {
  for (const bool v06 : {true, false}) {
    tests::PlayedOdrives drives;
    for (auto& axis : drives.axis) axis.v06 = v06;
    auto bus = drives.bus.bus();
    const auto start = bring_up_odrives(*bus, {}, 1000.0);
    ASSERT_TRUE(start) << start.error().message;
    EXPECT_EQ(start->generation, v06 ? OdriveGeneration::k06 : OdriveGeneration::k05);
  }
}

TEST(OdriveBringUp, ClearsWhatAKilledRunLeftBehind) {
  Bench bench;
  for (auto& axis : bench.drives.axis) axis.error = 0x1000000;
  EXPECT_EQ(bench.open(), "");
}

TEST(OdriveBringUp, TakesPowerFromDrivesThatStillHaveIt) {
  Bench bench;
  for (auto& axis : bench.drives.axis) axis.state = 8;
  EXPECT_EQ(bench.open(), "");
  for (const auto& axis : bench.drives.axis) EXPECT_EQ(axis.state, 1u);
}

TEST(OdriveBringUp, NamesTheArmThatIsMissing) {
  Bench bench;
  bench.drives.axis[1].powered = false;
  bench.expect_refused("arm 2 (node 2 on can0) sends no heartbeat");
}

TEST(OdriveBringUp, NoDriveIsDistinguishedFromWrongBitRateAndNoAcknowledge) {
  const auto silent = [](std::uint32_t classes, std::uint8_t controller) {
    auto bench = std::make_unique<Bench>();
    for (auto& axis : bench->drives.axis) axis.powered = false;
    if (classes != 0) bench->drives.bus.say_error(classes, controller);
    return bench;
  };
  silent(0, 0)->expect_refused("no drive is heard on can0");
  silent(0x020, 0)->expect_refused("no node on can0 acknowledges a frame: switch the drives on");
  silent(0x004, 0x20)->expect_refused("no node on can0 acknowledges a frame");
  silent(0x008, 0)->expect_refused("bit rate");
  silent(0x004, 0x10)->expect_refused("can0 understands nothing of what is on the bus");
  silent(0x040, 0)->expect_refused("can0 understands nothing of what is on the bus");
  auto full = silent(0, 0);
  full->drives.bus.socket().send_error = ENOBUFS;  // frames wait for an acknowledge in the queue
  full->expect_refused("no node on can0 acknowledges a frame");
}

TEST(OdriveBringUp, AnErrorThatStaysIsReportedAsText) {
  Bench bench;
  bench.drives.axis[2].error = 0x4000000;
  bench.drives.axis[2].stuck_error = true;
  bench.expect_refused("arm 3 (node 3 on can0): Power and motion do not fit");
}

TEST(OdriveBringUp, ThreeFirmwaresOfTwoGenerationsAreRefused) {
  Bench bench;
  bench.drives.axis[1].v06 = false;
  bench.expect_refused(
      "arm 2 (node 2 on can0) does not report its version while another drive does");
}

TEST(OdriveBringUp, ADriveThatReportsItsPositionTooSeldomIsNamed) {
  Bench bench;
  bench.drives.axis[0].position_every_ms = 10;  // the vendor's default
  bench.expect_refused("arm 1 (node 1 on can0) sends its position 100 times a second, not 1000");
  Bench mute;
  mute.drives.axis[0].says_position = false;
  mute.expect_refused("sends its position 0 times a second");
}

TEST(OdriveBringUp, AHeartbeatSlowerThanItsWatchIsNamedWithTheKeyToSet) {
  for (const int slow_ms : {340, 400, 500, 1000, 2000}) {
    for (const bool v06 : {true, false}) {
      Bench bench;
      for (auto& one : bench.drives.axis) one.v06 = v06;
      bench.drives.axis[1].heartbeat_every_ms = slow_ms;
      const std::string said = bench.open();
      EXPECT_TRUE(said.starts_with("arm 2 (node 2 on can0) sends its heartbeat every ")) << said;
      EXPECT_NE(said.find(v06 ? "set axis.config.can.heartbeat_msg_rate_ms = 100"
                              : "set axis.config.can.heartbeat_rate_ms = 100"),
                std::string::npos)
          << said;
      EXPECT_EQ(bench.device, nullptr);
    }
  }
}

TEST(OdriveBringUp, AHeartbeatThatItsWatchBearsIsTaken) {
  for (const int ms : {10, 100, 200, 290}) {
    Bench bench;
    for (auto& one : bench.drives.axis) one.heartbeat_every_ms = ms;
    EXPECT_EQ(bench.open(), "") << ms;
  }
}

TEST(OdriveBringUp, ADriveThatAnotherHostHoldsIsNamed) {
  Bench bench;
  bench.drives.axis[1].state = 3;
  bench.drives.axis[1].obeys = false;
  bench.expect_refused("arm 2 (node 2 on can0) does not go idle");
}

TEST(OdriveBringUp, ArmsThatMoveAreNotOnTheJig) {
  Bench bench;
  bench.drives.axis[2].turns_per_s = 0.5;
  bench.expect_refused("arm 3 (node 3 on can0) moves");
}

TEST(OdriveBringUp, AnglesThatNoArmHasAreNotHomed) {
  Bench bench;
  bench.settings.of<can::CanSettings>().homing = can::Homing::kAbsolute;
  bench.settings.of<can::CanSettings>().direction = {1.0, 1.0, 1.0};
  bench.drives.axis[1].turns = 3.5;  // 126 degrees at 10:1
  bench.expect_refused("the delta is not homed: arm 2 would be at 126 degrees");
}

TEST(OdriveBringUp, AbsoluteEncodersNeedNoJig) {
  Bench bench;
  bench.settings.of<can::CanSettings>().homing = can::Homing::kAbsolute;
  bench.settings.of<can::CanSettings>().zero_turns = {0.25, -0.5, 1.0};
  const auto pose = published_pose();
  const double sign[] = {1.0, -1.0, 1.0}, zero[] = {0.25, -0.5, 1.0};
  for (std::size_t i = 0; i < 3; ++i)
    bench.drives.axis[i].turns = zero[i] + sign[i] * 10.0 * pose.theta_rad[i] / 6.283185307179586;
  ASSERT_EQ(bench.open(), "");
  ASSERT_GT(bench.ticks_until_ready(), 0);
  EXPECT_NEAR(bench.sample.tool.position_m.z, pose.position_D_m.x, 1e-6);
}

TEST(OdriveBringUp, TheIndexSearchEndsBeforePositionsCount) {
  Bench bench;
  bench.settings.of<can::CanSettings>().homing = can::Homing::kIndex;
  bench.settings.of<can::CanSettings>().direction = {1.0, 1.0, 1.0};
  bench.drives.axis[1].index_ms = 2000;
  for (auto& axis : bench.drives.axis) axis.turns = 7.0;  // no arm has 252 degrees
  EXPECT_EQ(bench.open(), "");
  EXPECT_GT(bench.drives.time_ms, 2000);
}

TEST(OdriveBringUp, AnIndexThatIsNotFoundIsNamed) {
  Bench bench;
  bench.settings.of<can::CanSettings>().homing = can::Homing::kIndex;
  bench.drives.axis[1].index_ms = 1'000'000;
  bench.expect_refused("arm 2 (node 2 on can0) does not find its index pulse");
  Bench deaf;
  deaf.settings.of<can::CanSettings>().homing = can::Homing::kIndex;
  deaf.drives.axis[0].obeys = false;  // idle all the time, which is no search
  deaf.expect_refused("arm 1 (node 1 on can0) does not find its index pulse");
}

TEST(OdriveBringUp, NumbersThatCannotWorkAreRefusedAtOnce) {
  Bench fast, high, wired;
  const std::string too_fast = fast.open(2000.0);
  EXPECT_NE(too_fast.find("rate_Hz is 2000"), std::string::npos) << too_fast;
  EXPECT_NE(too_fast.find("set rate_Hz to 1000 or less"), std::string::npos) << too_fast;
  high.settings.of<can::CanSettings>().node = {1, 2, 99};
  high.expect_refused("an ODrive's node is 0 to 63");
  wired.settings.of<can::CanSettings>().homing = can::Homing::kIndex;
  wired.settings.of<LinesSettings>().chip = "gpiochip0";
  wired.settings.of<LinesSettings>().enable = 3;
  wired.expect_refused("device.lines.enable");
}

TEST(OdriveBringUp, TheCycleOfSixFramesFitsAMegabit) {
  EXPECT_EQ(odrive_cycle_bits({}), 3 * (95 + 135));
  OdriveSettings padded;
  padded.short_torque = false;
  EXPECT_EQ(odrive_cycle_bits(padded), 810);
}

}  // namespace tact::hal::odrive::odrive_bring_up_test
