// SPDX-License-Identifier: Apache-2.0
// A delta on ODrives as firmware 0.5.6 has them, the virtual bench's emulators.
#include <gtest/gtest.h>

#include "hal/odrive/odrive_delta.h"
#include "hal/odrive/odrive_protocol.h"
#include "hal/odrive/odrive_velocity_limit.h"
#include "tests/hal/emulated/emulated_drives.h"
#include "tests/rig/emulators/odrive/odrive_drive.h"

namespace tact::hal::emulated::odrive_emulated_test {

using can::Homing;
using rig::OdriveGeneration;
using tests::published_pose;

struct Drives : tests::EmulatedDrives {
  Drives() : EmulatedDrives(32) {}
};

struct Bench : tests::CanBench<Drives> {
  explicit Bench(const rig::OdriveSettings& drive = {.generation = OdriveGeneration::k05},
                 Homing homing = Homing::kJig)
      : CanBench(tests::jig_settings(published_pose())) {
    settings.of<can::CanSettings>().homing = homing;
    drives.install<rig::OdriveDrive>(drive);
    if (homing != Homing::kJig) put_arms_at(published_pose().theta_rad);
  }
  std::string open() { return CanBench::open(&odrive::start_odrive_delta); }
  void put_arms_at(const delta::Joints& theta_rad) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double sign = i == 1 ? -1.0 : 1.0;
      drives.motor[i].position_turns = sign * settings.of<can::DeltaSettings>().gear_ratio *
                                       theta_rad[i] / (2.0 * std::numbers::pi);
    }
  }
  /// Distance of the reported tool from the pose of the arms, m.
  double error_m() const {
    const Vec3 p_D = published_pose().position_D_m;
    const Vec3 p_W{p_D.z - 0.345, -p_D.y, p_D.x};
    return norm(sample.tool.position_m - p_W);
  }
};

TEST(OdriveEmulated, TheFirstStartAfterPowerOnKnowsWhereTheArmsAreInEveryHoming) {
  for (const Homing homing : {Homing::kAbsolute, Homing::kIndex, Homing::kJig}) {
    const double elsewhere_turns = homing == Homing::kIndex ? 3.7 : 0.0;
    Bench bench({.generation = OdriveGeneration::k05, .power_on_turns = elsewhere_turns}, homing);
    if (homing == Homing::kJig)  // wherever the encoders began
      for (auto& motor : bench.drives.motor) motor.position_turns = 0.7;
    ASSERT_EQ(bench.open(), "");
    ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
    EXPECT_LT(bench.error_m(), 2e-4);  // counts of the encoder
    EXPECT_EQ(bench.ticks_until(Fault::kHomingLost, 200), -1) << bench.device->fault_detail();
  }
}

TEST(OdriveEmulated, NearItsZeroTooAPositionIsProvedBeforeItCounts) {
  // 0.015 turn of a motor is 9.4 mrad of an arm: 3 mm at the tool, and no jump that could be seen.
  Bench bench;
  for (auto& motor : bench.drives.motor) motor.position_turns = 0.015;
  ASSERT_EQ(bench.open(), "");
  ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
  EXPECT_LT(bench.error_m(), 2e-4);
}

TEST(OdriveEmulated, ArmsThatLeaveTheJigBeforeTheyHavePowerAreFollowed) {
  Bench bench;  // all encoders at 0, as after power-on on the jig
  ASSERT_EQ(bench.open(), "");
  bench.permitted = false;
  for (int i = 0; i < 50; ++i) ASSERT_EQ(bench.tick(), Fault::kNone);
  EXPECT_LT(bench.error_m(), 2e-4);
  for (int i = 0; i < 100; ++i) {
    for (auto& motor : bench.drives.motor) {
      motor.position_turns += 0.001;
      motor.velocity_turns_per_s = 1.0;
    }
    ASSERT_EQ(bench.tick(), Fault::kNone) << bench.device->fault_detail();
  }
  EXPECT_GT(bench.error_m(), 5e-3);
}

TEST(OdriveEmulated, TheWayThroughClosedLoopIsOneAxisAfterTheOtherAtZeroTorque) {
  Bench bench;
  for (auto& motor : bench.drives.motor) motor.position_turns = 0.7;
  ASSERT_EQ(bench.open(), "");
  EXPECT_EQ(bench.drives.most_enabled, 1u);
  EXPECT_EQ(bench.drives.largest_torque_Nm, 0.0);
  for (const auto& drive : bench.drives.drive) EXPECT_FALSE(drive->is_enabled());
}

TEST(OdriveEmulated, MotorsWithoutSupplyStillReportWhereTheyAre) {
  // The enable line gives the motors their supply in the loop alone.
  for (const double turns : {0.7, 0.0}) {
    Bench bench({.generation = OdriveGeneration::k05, .motor_supply = false});
    for (auto& motor : bench.drives.motor) motor.position_turns = turns;
    ASSERT_EQ(bench.open(), "");
    bench.permitted = false;
    for (int i = 0; i < 50; ++i)
      ASSERT_EQ(bench.tick(), Fault::kNone) << bench.device->fault_detail();
    EXPECT_LT(bench.error_m(), 2e-4);
  }
}

TEST(OdriveEmulated, APositionThatCannotBeProvedIsRefused) {
  for (const double turns : {0.7, 0.0}) {
    Bench bench({.generation = OdriveGeneration::k05, .is_calibrated = false});
    for (auto& motor : bench.drives.motor) motor.position_turns = turns;
    const std::string message = bench.open();
    EXPECT_NE(message.find("reports position 0 while its encoder counts"), std::string::npos)
        << message;
    EXPECT_NE(message.find("calibrate motor and encoder first"), std::string::npos) << message;
  }
}

TEST(OdriveEmulated, ARefusedIndexSearchIsReportedAtOnceByTheDrivesOwnError) {
  Bench bench({.generation = OdriveGeneration::k05, .is_calibrated = false}, Homing::kIndex);
  const std::int64_t before_ns = bench.drives.now_ns;
  const std::string message = bench.open();
  EXPECT_NE(message.find("arm 1 (node 1 on can0): The drive cannot enter the state that was asked "
                         "for: calibrate motor and encoder first"),
            std::string::npos)
      << message;
  EXPECT_LT(bench.drives.now_ns - before_ns, 3'000'000'000);
}

TEST(OdriveEmulated, DrivesThatKnowTheirPositionGetNoPowerAtOpening) {
  for (const auto generation : {OdriveGeneration::k05, OdriveGeneration::k06}) {
    Bench bench({.generation = generation, .estimates_from_power_on = true}, Homing::kAbsolute);
    ASSERT_EQ(bench.open(), "");
    EXPECT_EQ(bench.drives.most_enabled, 0u);
  }
}

TEST(OdriveEmulated, RestartOrReturnedPermissionNeedsNoNewPositionProof) {
  Bench bench({.generation = OdriveGeneration::k05}, Homing::kAbsolute);
  ASSERT_EQ(bench.open(), "");
  ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
  bench.permitted = false;
  for (int i = 0; i < 200; ++i)
    ASSERT_EQ(bench.tick(), Fault::kNone) << bench.device->fault_detail();
  bench.permitted = true;
  ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
  bench.drives.bus.socket().send_error = ENOBUFS;  // killed: nothing more of it reaches a drive
  bench.device.reset();
  for (int i = 0; i < 100; ++i) bench.drives.millisecond();
  for (const auto& drive : bench.drives.drive) EXPECT_FALSE(drive->is_enabled()) << "its watchdog";
  bench.drives.connect_again();
  bench.drives.most_enabled = 0;
  ASSERT_EQ(bench.open(), "");
  EXPECT_EQ(bench.drives.most_enabled, 0u);
  ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
  EXPECT_LT(bench.error_m(), 2e-4);
}

TEST(OdriveEmulated, ShutdownFramesZeroTorqueThenPowerOff) {
  for (const auto generation : {OdriveGeneration::k05, OdriveGeneration::k06}) {
    Bench bench({.generation = generation, .estimates_from_power_on = true}, Homing::kAbsolute);
    ASSERT_EQ(bench.open(), "");
    const auto frames = bench.device->shutdown_frames();  // before the loop, as tactd asks for them
    ASSERT_TRUE(frames);
    ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
    for (int i = 0; i < 3; ++i) bench.tick({0.0, 0.0, 4.0});
    ASSERT_NE(bench.drives.drive[0]->torque_Nm(), 0.0);
    bench.drives.expect_freed_by(*frames);
  }
}

TEST(OdriveEmulated, ShutdownFramesAreZeroTorqueAndIdleAlone) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  const auto frames = bench.device->shutdown_frames();
  ASSERT_TRUE(frames && frames->count == 9);
  for (std::size_t i = 0; i < frames->count; ++i) {
    const auto frame = can::unpack_can_frame(frames->bytes_of(i));
    ASSERT_TRUE(frame);
    const int node = odrive::odrive_address(*frame).node;
    EXPECT_TRUE(node >= 1 && node <= 3);
    EXPECT_TRUE(
        *frame == *odrive::odrive_axis_state(node, odrive::OdriveAxisState::kIdle) ||
        *frame == *odrive::odrive_input_torque(node, 0.0, odrive::OdriveTorqueLength::kShort) ||
        *frame == *odrive::odrive_input_torque(node, 0.0, odrive::OdriveTorqueLength::kPadded));
  }
}

/// Along the tool's axis, away from the operator, the arms give most.
constexpr Vec3 kPush_N{-20.0, 0.0, 0.0};
constexpr rig::OdriveSettings kAsDelivered{.generation = OdriveGeneration::k05,
                                           .torque_velocity_limit = true,
                                           .velocity_limit_turns_per_s = 2.0};

TEST(OdriveEmulated, TorqueCutByTheDrivesVelocityLimitIsReportedWithNumbers) {
  Bench bench(kAsDelivered);
  ASSERT_EQ(bench.open(), "");
  const std::string caution = bench.device->info().caution;
  const auto reported = odrive::odrive_velocity_limit(bench.settings.of<can::DeltaSettings>(), 2.0);
  EXPECT_NE(caution.find("may cut torque above 0.33 N m at rest, of the 0.74 N m"),
            std::string::npos)
      << caution;
  EXPECT_NE(caution.find("stops the drive at 0.35 m/s"), std::string::npos) << caution;
  EXPECT_NE(caution.find("enable_torque_mode_vel_limit = False"), std::string::npos) << caution;
  ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
  for (int i = 0; i < 3; ++i) bench.tick(kPush_N);
  EXPECT_NEAR(bench.drives.largest_torque_Nm, 0.333, 1e-3) << "the drive cuts it, silently";
  const auto wanted = tests::expected_motor_Nm(bench.settings, published_pose(), kPush_N);
  double largest_Nm = 0.0;
  for (const double one_Nm : wanted) largest_Nm = std::max(largest_Nm, std::abs(one_Nm));
  EXPECT_GT(largest_Nm, 0.4);
  EXPECT_LE(largest_Nm, reported.motor_torque_Nm);
}

TEST(OdriveEmulated, AVelocityLimitOfTheSceneLetsAllTorquePassAndIsNotWarnedOf) {
  Bench bench(kAsDelivered);
  bench.settings.of<odrive::OdriveSettings>().max_velocity_turns_per_s =
      odrive::odrive_velocity_limit(bench.settings.of<can::DeltaSettings>(), 2.0).least_turns_per_s;
  bench.settings.of<odrive::OdriveSettings>().max_current_A = 20.0;
  ASSERT_EQ(bench.open(), "");
  EXPECT_EQ(bench.device->info().caution, "");
  ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
  for (int i = 0; i < 3; ++i) bench.tick(kPush_N);
  const auto wanted = tests::expected_motor_Nm(bench.settings, published_pose(), kPush_N);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(bench.drives.drive[i]->torque_Nm(), wanted[i], 1e-6);
}

TEST(OdriveEmulated, AVelocityLimitOfTheSceneThatMayCutTorqueAtRestIsRefused) {
  Bench bench(kAsDelivered);
  bench.settings.of<odrive::OdriveSettings>().max_velocity_turns_per_s = 3.0;
  bench.settings.of<odrive::OdriveSettings>().max_current_A = 20.0;
  const std::string message = bench.open();
  EXPECT_NE(message.find("max_velocity_turns_per_s = 3 may cut torque above 0.50 N m at rest"),
            std::string::npos)
      << message;
}

TEST(OdriveEmulated, OverspeedOfADriveIsReportedAsItsCause) {
  for (const auto generation : {OdriveGeneration::k05, OdriveGeneration::k06}) {
    Bench bench({.generation = generation, .velocity_limit_turns_per_s = 2.0});
    ASSERT_EQ(bench.open(), "");
    ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
    for (auto& motor : bench.drives.motor) motor.velocity_turns_per_s = 2.5;
    int ticks = 0;
    for (Fault fault = Fault::kNone; fault == Fault::kNone && ticks < 150; ++ticks) {
      for (auto& motor : bench.drives.motor) motor.position_turns += 0.0025;
      fault = bench.tick();
    }
    const std::string words = bench.device->fault_detail();
    EXPECT_TRUE(words.find("overspeed") != std::string::npos ||
                words.find("elocity") != std::string::npos)
        << words;
  }
}

}  // namespace tact::hal::emulated::odrive_emulated_test
