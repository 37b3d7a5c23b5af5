// SPDX-License-Identifier: Apache-2.0
// A delta on CiA 402 drives as several vendors have them, the virtual bench's emulators.
#include <gtest/gtest.h>

#include <utility>

#include "hal/can/can_settings.h"
#include "hal/cia402/cia402_cst.h"
#include "hal/cia402/cia402_delta.h"
#include "hal/cia402/cia402_state.h"
#include "hal/cia402/heartbeat_guard.h"
#include "tests/hal/emulated/cia402_emulated_bench.h"

namespace tact::hal::emulated::cia402_emulated_test {

using Bench = Cia402Bench;

/// Every habit alone, and all of them at once.
std::vector<ObjectHabits> all_habits() {
  return {{},
          {.no_request_stays = true},
          {.watch_off_first = true},
          {.sizes_unsaid = true},
          {.absent = {0x100C, 0x100D, 0x6007, 0x60C2, 0x605A, 0x6502, 0x6061}},
          {.guard_time_ms = 100, .life_time_factor = 4, .life_from_boot = true},
          {.no_request_stays = true,
           .watch_off_first = true,
           .sizes_unsaid = true,
           .absent = {0x6007, 0x60C2, 0x605A},
           .guard_time_ms = 100,
           .life_time_factor = 4,
           .life_from_boot = true}};
}

TEST(Cia402Emulated, EveryVendorsDriveGivesTheTorquesThatItIsAskedFor) {
  for (const ObjectHabits& habits : all_habits()) {
    Bench bench(habits);
    ASSERT_TRUE(bench.run());
    bench.expect_torques_of({1.0, -2.0, 3.0});
    EXPECT_FALSE(bench.drives.any_noted());
  }
}

TEST(Cia402Emulated, PermissionThatIsTakenAndComesBackLeavesNoFaultInTheLog) {
  for (const ObjectHabits& habits : all_habits()) {
    Bench bench(habits);
    ASSERT_TRUE(bench.run());
    for (int press = 0; press < 3; ++press) {
      bench.permitted = false;
      bench.expect_no_fault_for(300);
      for (const auto& drive : bench.drives.drive) EXPECT_FALSE(drive->is_enabled());
      bench.permitted = true;
      ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
    }
    bench.expect_torques_of({0.0, 0.0, 4.0});
    EXPECT_FALSE(bench.drives.any_noted());
  }
}

TEST(Cia402Emulated, AnEndThatIsPlannedLeavesNoFaultInTheLog) {
  for (const ObjectHabits& habits : all_habits()) {
    Bench bench(habits);
    ASSERT_TRUE(bench.run());
    bench.expect_torques_of({0.0, 0.0, 4.0});
    bench.device->stop();
    for (int i = 0; i < 200; ++i) bench.drives.millisecond();
    for (const auto& drive : bench.drives.drive) EXPECT_FALSE(drive->is_enabled());
    EXPECT_FALSE(bench.drives.any_noted());
  }
}

TEST(Cia402Emulated, AKilledRunIsMissedAndTheNextStartNeedsNoPowerCycle) {
  for (const ObjectHabits& habits : all_habits()) {
    Bench bench(habits);
    ASSERT_TRUE(bench.run());
    bench.drives.bus.socket().send_error = ENOBUFS;  // killed: nothing more of it reaches a drive
    bench.device.reset();
    for (int i = 0; i < 200; ++i) bench.drives.millisecond();
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_FALSE(bench.drives.drive[i]->is_enabled());
      EXPECT_EQ(bench.drives.at(i).noted(), std::vector<std::uint16_t>{0x8130});
    }
    bench.drives.connect_again();
    ASSERT_TRUE(bench.run());
    bench.expect_torques_of({0.0, 0.0, 4.0});
  }
}

TEST(Cia402Emulated, ALifeTimeThatAnotherHostLeftRunningStopsNoDriveUnderTactd) {
  for (const bool from_boot : {false, true}) {
    Bench bench({.guard_time_ms = 100, .life_time_factor = 5, .life_from_boot = from_boot});
    if (!from_boot) bench.guard();  // for the last time, then that host is gone
    ASSERT_TRUE(bench.run());
    bench.expect_no_fault_for(2000);
    bench.expect_torques_of({1.0, -2.0, 3.0});
    EXPECT_FALSE(bench.drives.any_noted());
  }
}

TEST(Cia402Emulated, AKilledRunIsMissedInTimeForAnyStoredLifeTime) {
  Bench bench({.guard_time_ms = 1000, .life_time_factor = 200, .life_hides_host = true});
  bench.guard();
  ASSERT_TRUE(bench.run());
  bench.expect_torques_of({0.0, 0.0, 4.0});
  bench.drives.bus.socket().send_error = ENOBUFS;  // killed
  for (int i = 0; i < 25; ++i) bench.drives.millisecond();
  for (const auto& drive : bench.drives.drive) EXPECT_EQ(drive->torque_Nm(), 0.0);
}

TEST(Cia402Emulated, ADriveWithNodeGuardingAloneIsRefusedAndStaysGuarded) {
  for (const std::uint16_t heartbeat : {std::uint16_t{0x1016}, std::uint16_t{0x1017}}) {
    Bench bench({.absent = {heartbeat}, .guard_time_ms = 100, .life_time_factor = 5});
    bench.guard();
    const std::string message = bench.open();
    EXPECT_NE(message.find("its node guarding (object 100C) is not used: update its firmware"),
              std::string::npos)
        << message;
    for (int i = 0; i < 600; ++i) bench.drives.millisecond();
    EXPECT_EQ(bench.drives.at(0).noted(), std::vector<std::uint16_t>{0x8130})
        << "as the other host has set it";
  }
}

TEST(Cia402Emulated, ShutdownFramesZeroTorqueThenPowerOffAndKeepWatchdog) {
  for (const ObjectHabits& habits : all_habits()) {
    Bench bench(habits);
    ASSERT_EQ(bench.open(), "");
    const auto frames = bench.device->shutdown_frames();  // before the loop, as tactd asks for them
    ASSERT_TRUE(frames);
    ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
    bench.expect_torques_of({0.0, 0.0, 4.0});
    bench.drives.expect_freed_by(*frames);
    for (int i = 0; i < 200; ++i) bench.drives.millisecond();
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(bench.drives.at(i).noted(), std::vector<std::uint16_t>{0x8130})
          << "it misses its host all the same";
    bench.drives.bus.socket().send_error = ENOBUFS;
  }
}

TEST(Cia402Emulated, ShutdownFramesAreZeroTorqueDisabledAndSyncAlone) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  const auto frames = bench.device->shutdown_frames();
  ASSERT_TRUE(frames && frames->count == 12);
  for (std::size_t i = 0; i < frames->count; ++i) {
    const auto frame = can::unpack_can_frame(frames->bytes_of(i));
    ASSERT_TRUE(frame);
    if (*frame == cia402::canopen_sync()) continue;
    const int node = static_cast<int>(frame->id) - 0x200;
    EXPECT_TRUE(node >= 1 && node <= 3) << frame->id;
    EXPECT_TRUE(*frame == *cia402::cst_command(node, cia402::kControlQuickStop, 0) ||
                *frame == *cia402::cst_command(node, cia402::kControlDisableVoltage, 0));
  }
}

TEST(Cia402Emulated, FaultOfOneDriveDisablesTheOthersWithoutALoggedFault) {
  Bench bench;
  ASSERT_TRUE(bench.run());
  bench.drives.drive[1]->fail(bench.drives.now_ns);
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 20), 0);
  for (int i = 0; i < 500; ++i) bench.tick();
  EXPECT_TRUE(bench.drives.at(0).noted().empty());
  EXPECT_TRUE(bench.drives.at(2).noted().empty());
  for (const auto& drive : bench.drives.drive) EXPECT_FALSE(drive->is_enabled());
  EXPECT_EQ(bench.allocations, 0u);
}

TEST(Cia402Emulated, ARatedTorqueThatNoDriveReportsIsInTheScene) {
  Bench silent({.absent = {0x6076}}), reported({.absent = {0x6076}});
  const std::string message = silent.open();
  EXPECT_NE(message.find("does not report its rated torque (object 6076): set "
                         "device.can.rated_torque_Nm"),
            std::string::npos)
      << message;
  reported.settings.of<cia402::Cia402Settings>().rated_torque_Nm = kRated_Nm;
  ASSERT_TRUE(reported.run());
  reported.expect_torques_of({1.0, -2.0, 3.0});
}

TEST(Cia402Emulated, ARatedTorqueOfTheSceneOverridesTheDrives) {
  Bench bench;
  bench.settings.of<cia402::Cia402Settings>().rated_torque_Nm = 2.0 * kRated_Nm;
  ASSERT_TRUE(bench.run());
  for (int i = 0; i < 3; ++i) bench.tick({1.0, -2.0, 3.0});
  const auto wanted = tests::expected_motor_Nm(bench.settings, published_pose(), {1.0, -2.0, 3.0});
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(bench.drives.drive[i]->torque_Nm(), 0.5 * wanted[i], 0.5e-3 * kRated_Nm);
}

TEST(Cia402Emulated, SettingsThatADriveDoesNotHaveAreReportedOnce) {
  Bench all, none({.absent = {0x6007, 0x605A, 0x60C2}});
  ASSERT_EQ(all.open(), "");
  EXPECT_EQ(all.device->info().caution, "");
  ASSERT_EQ(none.open(), "");
  const std::string caution = none.device->info().caution;
  EXPECT_NE(caution.find("the drives of nodes 1, 2, 3 have no setting 0x6007: what they do when "
                         "tactd is gone"),
            std::string::npos)
      << caution;
  EXPECT_NE(caution.find("have no setting 0x605A: how they stop"), std::string::npos) << caution;
  EXPECT_NE(caution.find("have no setting 0x60C2: their period"), std::string::npos) << caution;
}

TEST(Cia402Emulated, ADriveThatStaysInAnotherModeIsRefused) {
  Bench velocity({.mode_shown = 3}), late({.mode_shown = 0});
  const std::string message = velocity.open();
  EXPECT_NE(message.find("arm 1 (node 1 on can0) stays in mode 3 of operation (object 6061)"),
            std::string::npos)
      << message;
  ASSERT_TRUE(late.run());
}

TEST(Cia402Emulated, AWatchThatWasLeftOpenIsSwitchedOffBeforeItIsAskedForAgain) {
  cia402::HeartbeatGuard guard;
  const cia402::CstConfiguration can;
  const auto asks = [&](bool wanted) {
    for (int tick = 0; tick <= cia402::HeartbeatGuard::kTimeout_ticks; ++tick)
      if (const auto frame = guard.step(wanted, 1, can)) return static_cast<int>(frame->data[4]);
    return -1;
  };
  const auto answer = [&](cia402::SdoReplyKind kind) {
    guard.take({.kind = kind, .index = 0x1016, .sub = 1});
  };
  using enum cia402::SdoReplyKind;
  EXPECT_EQ(asks(false), 0);
  answer(kDownloadDone);
  for (const bool refused : {false, true}) {
    EXPECT_EQ(asks(true), 20);
    if (refused) answer(kAbort);  // else no answer comes: it may be on
    EXPECT_FALSE(guard.on());
    EXPECT_EQ(asks(true), 0) << "off first";
    answer(kDownloadDone);
  }
  EXPECT_EQ(asks(true), 20);
  answer(kDownloadDone);
  EXPECT_TRUE(guard.on());
}

/// While its STO is low, the controlword has no effect.
struct StoDrive final : rig::Drive {
  StoDrive(int axis, int at, const std::pair<rig::Cia402Settings, const bool*>& of,
           rig::CanBus& bus, const rig::Motor& motor, const rig::FaultPlan& faults)
      : drive(axis, at, of.first, bus, motor, faults), node(at), low(of.second) {}
  bool receive(const canfd_frame& frame, std::int64_t now_ns) override {
    canfd_frame heard = frame;
    const bool is_command = (heard.can_id & CAN_SFF_MASK) == 0x200u + static_cast<unsigned>(node);
    if (*low && is_command) heard.data[0] = heard.data[1] = 0;
    return drive.receive(heard, now_ns);
  }
  void tick(std::int64_t now_ns) override { drive.tick(now_ns); }
  void fail(std::int64_t now_ns) override { drive.fail(now_ns); }
  bool warn(std::int64_t now_ns) override { return drive.warn(now_ns); }
  bool is_enabled() const override { return drive.is_enabled(); }
  double torque_Nm() const override { return drive.torque_Nm(); }
  bool tripped() override { return drive.tripped(); }

  rig::Cia402Drive drive;
  int node;
  const bool* low;
};

TEST(Cia402Emulated, ThreeDrivesWithTheirStoLowAtBootAreWaitedForAndThenTakeForce) {
  bool low = true;
  tests::CanBench<Cia402Drives> bench(tests::jig_settings(published_pose()));
  bench.drives.install<StoDrive>(
      std::pair<rig::Cia402Settings, const bool*>{{.rated_torque_Nm = kRated_Nm}, &low});
  for (int i = 0; i < 50; ++i) bench.drives.millisecond();
  ASSERT_EQ(bench.open(&cia402::start_cia402_delta), "");
  for (int i = 0; i < 10'000; ++i) {
    ASSERT_EQ(bench.tick(), Fault::kNone) << i << ": " << bench.device->fault_detail();
    ASSERT_FALSE(bench.device->ready()) << i;
    for (const auto& drive : bench.drives.drive) ASSERT_EQ(drive->torque_Nm(), 0.0);
  }
  EXPECT_NE(bench.device->fault_detail().find("waiting for power of arm "), std::string::npos)
      << bench.device->fault_detail();
  low = false;
  EXPECT_GT(bench.ticks_until_ready(1000), 0) << bench.device->fault_detail();
  EXPECT_EQ(bench.device->fault_detail(), "");
  for (int i = 0; i < 100; ++i) ASSERT_EQ(bench.tick({0.0, 0.0, 1.0}), Fault::kNone);
  low = true;  // after a force it is a fault, as ever
  int ticks = 0;
  while (ticks < 200 && bench.tick({0.0, 0.0, 1.0}) == Fault::kNone) ++ticks;
  EXPECT_LT(ticks, 20);
  EXPECT_EQ(bench.read_fault, Fault::kDriveFault);
}

}  // namespace tact::hal::emulated::cia402_emulated_test
