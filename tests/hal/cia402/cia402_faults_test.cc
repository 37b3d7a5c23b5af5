// SPDX-License-Identifier: Apache-2.0
// Every fault of a CiA 402 delta: seen, named, latched, and no torque after it.
#include <gtest/gtest.h>

#include <vector>

#include "hal/cia402/cia402_cst.h"
#include "hal/cia402/cia402_delta.h"
#include "tests/hal/cia402/cia402_bench.h"

namespace tact::hal::cia402::cia402_faults_test {

using Bench = tests::Cia402Bench;

TEST(Cia402Faults, WithoutPositionsTorqueFadesIn12TicksAndTheDeviceIsLostIn20) {
  Bench bench;
  bench.run();
  bench.tick();
  const int full = bench.drives.axis[0].permille;
  ASSERT_NE(full, 0) << "gravity";
  bench.drives.axis[1].says_sample = false;
  bench.tick();  // what SYNC asked for before is still heard
  ASSERT_TRUE(bench.sample.fresh);
  for (int missing = 1; missing < 20; ++missing) {
    ASSERT_EQ(bench.tick(), Fault::kNone);
    const int permille = bench.drives.axis[0].permille;
    if (missing == 1)
      EXPECT_EQ(permille, full);
    else if (missing < 11)
      EXPECT_NEAR(permille, full * (11 - missing) / 10.0, 0.51);
    else
      for (const auto& axis : bench.drives.axis) EXPECT_EQ(axis.permille, 0);
  }
  EXPECT_EQ(bench.tick(), Fault::kDeviceLost);
  EXPECT_FALSE(bench.device->ready());
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): no position for 20 ms"))
      << bench.device->fault_detail();
  bench.expect_stopped();
  bench.expect_latched(Fault::kDeviceLost);
}

TEST(Cia402Faults, AFaultStateStopsAllThreeInTheSameTickAndGetsItsReason) {
  Bench bench;
  bench.run();
  bench.drives.axis[1].status = 0x08;
  bench.drives.axis[1].stuck_fault = true;
  bench.tick({0.0, 0.0, 5.0});  // its sample is on the way
  EXPECT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kDriveFault);
  EXPECT_EQ(bench.drives.axis[0].controlword, 0x02);
  EXPECT_EQ(bench.drives.axis[0].permille, 0);
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): the drive is in its fault state"));
  bench.drives.say_emergency(bench.drives.axis[1], 0x3220);
  bench.tick();
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): DC bus voltage too low"))
      << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(Cia402Faults, EmergencyMessageIsAFaultAndAnErrorResetIsNot) {
  Bench bench;
  bench.run();
  bench.drives.say_emergency(bench.drives.axis[0], 0x0000);
  EXPECT_EQ(bench.tick(), Fault::kNone);
  bench.drives.say_emergency(bench.drives.axis[2], 0x8130);
  EXPECT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kDriveFault);
  EXPECT_TRUE(bench.says("arm 3 (node 3 on can0): The drive missed the controller's heartbeat"))
      << bench.device->fault_detail();
  bench.expect_stopped();
  bench.drives.say_emergency(bench.drives.axis[2], 0x0000);
  bench.expect_latched(Fault::kDriveFault);
}

TEST(Cia402Faults, LeavingOperationEnabledAfterAForceIsAFault) {
  Bench bench;
  bench.run();
  EXPECT_EQ(bench.tick({0.0, 0.0, 1.0}), Fault::kNone);
  bench.drives.axis[0].status = 0x23;
  bench.drives.axis[0].obeys = false;
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 3), 0);
  EXPECT_TRUE(
      bench.says("arm 1 (node 1 on can0): the drive left operation by itself and is "
                 "switched_on"))
      << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(Cia402Faults, ADriveThatDoesNotFollowTheTorqueIsNamed) {
  Bench bench;
  bench.run();
  bench.drives.axis[1].follows = false;
  const int ticks = bench.ticks_until(Fault::kDriveFault, 100);
  EXPECT_GE(ticks, 20);
  EXPECT_LE(ticks, 22);
  EXPECT_TRUE(bench.says("does not follow the torque")) << bench.device->fault_detail();
}

TEST(Cia402Faults, ATorqueThatWasNotCommandedIsNamed) {
  Bench bench;
  bench.run();
  EXPECT_EQ(bench.tick({0.0, 0.0, 1.0}), Fault::kNone);
  bench.drives.axis[1].extra_permille = 400;
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 200), 0);
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): the drive gives 0."))
      << bench.device->fault_detail();
  EXPECT_TRUE(bench.says("that was not commanded (object 6077)")) << bench.device->fault_detail();
  bench.expect_stopped();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(Cia402Faults, LessTorqueThanCommandedIsALimitOfTheDrive) {
  Bench bench;
  bench.run();
  for (int i = 0; i < 400; ++i) {
    const double force_N = i % 100 < 50 ? 2.0 : -2.0;  // a torque that turns round is late
    for (auto& one : bench.drives.axis)
      one.extra_permille = static_cast<std::int16_t>(-one.permille / 2);
    ASSERT_EQ(bench.tick({0.0, 0.0, force_N}), Fault::kNone) << i << bench.device->fault_detail();
  }
}

TEST(Cia402Faults, ASilentDriveIsFoundWithin36Milliseconds) {
  Bench bench;
  bench.run();
  bench.drives.axis[2].says_heartbeat = false;
  const int ticks = bench.ticks_until(Fault::kDriveSilent, 100);
  EXPECT_GT(ticks, 25);
  EXPECT_LE(ticks, 36);
  EXPECT_TRUE(bench.says("arm 3 (node 3 on can0): no heartbeat")) << bench.device->fault_detail();
  bench.expect_stopped();
  bench.expect_latched(Fault::kDriveSilent);
}

TEST(Cia402Faults, ADriveThatRestartsIsNamed) {
  Bench bench;
  bench.run();
  bench.drives.axis[0].nmt = NmtState::kBoot;
  bench.drives.say_heartbeat(bench.drives.axis[0]);
  EXPECT_EQ(bench.tick(), Fault::kDriveFault);
  EXPECT_TRUE(bench.says("arm 1 (node 1 on can0): the drive restarted"))
      << bench.device->fault_detail();
}

TEST(Cia402Faults, ADriveWithoutPowerAtTheStartIsWaitedForAndNamed) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  bench.drives.axis[1].obeys = false;
  for (int i = 0; i < 20'000; ++i) {
    ASSERT_EQ(bench.tick(), Fault::kNone) << i << ": " << bench.device->fault_detail();
    ASSERT_FALSE(bench.device->ready());
  }
  EXPECT_TRUE(
      bench.says("waiting for power of arm 2 (node 2 on can0): the drive is "
                 "switch_on_disabled (statusword 0x0040)"))
      << bench.device->fault_detail();
  bench.drives.axis[1].obeys = true;
  EXPECT_GT(bench.ticks_until_ready(), 0);
  EXPECT_EQ(bench.device->fault_detail(), "");
}

TEST(Cia402Faults, ADriveThatKeepsNoWatchIsReportedWhileAnEarlierOneWaits) {
  Bench bench;
  bench.run();
  bench.permitted = false;
  for (int i = 0; i < 10; ++i) bench.tick();
  bench.drives.axis[0].obeys = false;
  bench.drives.axis[1].answers_watch = false;
  bench.permitted = true;
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 4000), 2900) << bench.device->fault_detail();
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): the drive does not take up its watch"))
      << bench.device->fault_detail();
}

TEST(Cia402Faults, PowerThatGoesBeforeAnyForceIsWaitedForAgain) {
  Bench bench;
  bench.run();
  bench.drives.axis[0].status = 0x40;
  bench.drives.axis[0].obeys = false;
  for (int i = 0; i < 5000; ++i) ASSERT_EQ(bench.tick(), Fault::kNone) << i;
  EXPECT_FALSE(bench.device->ready());
  EXPECT_TRUE(bench.says("waiting for power of arm 1 (node 1 on can0): the drive is "))
      << bench.device->fault_detail();
  bench.drives.axis[0].obeys = true;
  EXPECT_GT(bench.ticks_until_ready(), 0);
}

TEST(Cia402Faults, BusOffAndBusDownLatchAndAFullQueueDoesNot) {
  Bench off, down, full;
  off.run();
  off.drives.bus.say_error(0x040, 0);
  EXPECT_EQ(off.tick({0.0, 0.0, 5.0}), Fault::kBusOff);
  off.expect_stopped();
  off.expect_latched(Fault::kBusOff);
  down.run();
  down.drives.bus.socket().send_error = ENETDOWN;
  EXPECT_EQ(down.tick(), Fault::kBusDown);
  down.expect_latched(Fault::kBusDown);
  full.run();
  full.drives.bus.socket().send_error = ENOBUFS;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(full.tick(), Fault::kNone);
  full.drives.bus.socket().send_error = 0;
  full.tick();
  EXPECT_FALSE(full.sample.fresh) << "no SYNC, no sample";
  full.tick();
  EXPECT_TRUE(full.sample.fresh);
}

TEST(Cia402Faults, ACommandOfAnotherSenderLatchesInTheTickThatHearsIt) {
  std::vector<can::CanFrame> frames{
      canopen_sync(), *canopen_nmt(NmtCommand::kResetNode, kCanopenAllNodes),
      *canopen_nmt(NmtCommand::kStop, 2),
      *canopen_heartbeat(CstConfiguration{}.host_node, NmtState::kOperational),
      *canopen_sdo_upload(3, 0x6064, 0)};
  for (const std::uint32_t base : kCanopenToNode)
    frames.push_back(can::make_can_frame(base + 1, 4));
  for (const can::CanFrame& frame : frames) {
    Bench bench;
    bench.run();
    for (int i = 0; i < 20; ++i) ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone);
    ASSERT_EQ(bench.count("foreign_commands"), 0u) << "no false alarm";
    bench.drives.bus.say(frame);
    EXPECT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kForeignCommand) << frame.id;
    EXPECT_EQ(bench.count("foreign_commands"), 1u);
    EXPECT_TRUE(bench.says("a command that tactd did not send")) << bench.device->fault_detail();
    bench.expect_stopped();
    bench.expect_latched(Fault::kForeignCommand);
  }
}

TEST(Cia402Faults, TwoDrivesWithOneNodeIdLatch) {
  Bench bench;
  bench.run();
  int ticks = 1;
  for (; ticks < 20; ++ticks) {
    bench.drives.say_sample(bench.drives.axis[1]);
    if (bench.tick({0.0, 0.0, 5.0}) != Fault::kNone) break;
  }
  EXPECT_LE(ticks, 3);
  EXPECT_TRUE(bench.says("two drives have this node id")) << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

}  // namespace tact::hal::cia402::cia402_faults_test
