// SPDX-License-Identifier: Apache-2.0
// Every fault of an ODrive delta: seen, named, latched, and no torque after it.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/hal/odrive/odrive_faults_bench.h"

namespace tact::hal::odrive::odrive_faults_test {

using enum OdriveCommand;

using Bench = tests::OdriveFaultsBench;

TEST(OdriveFaults, ADrivesErrorStopsAllThreeInTheSameTick) {
  Bench bench;
  bench.run();
  bench.drives.axis[1].error = 0x200;
  bench.drives.say_heartbeat(bench.drives.axis[1]);
  EXPECT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kDriveFault);
  bench.expect_stopped();
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): DC bus voltage too low"))
      << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(OdriveFaults, BitsOf05AreReadAs05) {
  Bench bench(false);
  bench.run();
  bench.drives.axis[0].error = 0x100;  // over-voltage in 0.6, the encoder in 0.5
  bench.drives.say_heartbeat(bench.drives.axis[0]);
  EXPECT_EQ(bench.tick(), Fault::kDriveFault);
  EXPECT_TRUE(bench.says("arm 1")) << bench.device->fault_detail();
  EXPECT_TRUE(bench.says("ENCODER_FAILED")) << bench.device->fault_detail();
}

TEST(OdriveFaults, APartOf05ThatFailsIsNamedEvenWithoutAnErrorOfTheAxis) {
  Bench bench(false);
  bench.run();
  bench.drives.axis[2].parts = 1;
  bench.drives.say_heartbeat(bench.drives.axis[2]);
  EXPECT_EQ(bench.tick(), Fault::kDriveFault);
  EXPECT_TRUE(bench.says("arm 3 (node 3 on can0): the encoder reports"))
      << bench.device->fault_detail();
}

TEST(OdriveFaults, AnAxisThatGoesIdleByItselfIsAFault) {
  Bench bench;
  bench.run();
  bench.drives.axis[2].state = 1;
  bench.drives.say_heartbeat(bench.drives.axis[2]);
  EXPECT_EQ(bench.tick(), Fault::kDriveFault);
  EXPECT_TRUE(bench.says("arm 3")) << bench.device->fault_detail();
  EXPECT_TRUE(bench.says("is idle")) << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(OdriveFaults, ASilentHeartbeatIsFoundWithin350Milliseconds) {
  Bench bench;
  bench.run();
  bench.drives.axis[1].says_heartbeat = false;
  const int ticks = bench.ticks_until(Fault::kDriveSilent, 400);
  EXPECT_GT(ticks, 250);
  EXPECT_LE(ticks, 351);
  bench.expect_stopped();
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): no heartbeat for 35"))
      << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveSilent);
}

TEST(OdriveFaults, WithoutPositionsTorqueFadesIn12TicksAndTheDeviceIsLostIn20) {
  Bench bench;
  bench.run();
  bench.tick();
  const auto full_Nm = static_cast<double>(bench.drives.axis[0].torque_Nm);
  ASSERT_NE(full_Nm, 0.0) << "gravity";
  for (auto& axis : bench.drives.axis) axis.says_position = false;  // heartbeats go on
  for (int missing = 1; missing < 20; ++missing) {
    ASSERT_EQ(bench.tick(), Fault::kNone);
    const auto torque_Nm = static_cast<double>(bench.drives.axis[0].torque_Nm);
    if (missing == 1)
      EXPECT_EQ(torque_Nm, full_Nm);
    else if (missing < 11)
      EXPECT_NEAR(torque_Nm, full_Nm * (11 - missing) / 10.0, 1e-6);
    else
      for (const auto& axis : bench.drives.axis) EXPECT_EQ(axis.torque_Nm, 0.0f);
  }
  EXPECT_EQ(bench.tick(), Fault::kDeviceLost);
  EXPECT_FALSE(bench.device->ready());
  EXPECT_TRUE(bench.says("no new position for 20 ms")) << bench.device->fault_detail();
  bench.expect_stopped();
  for (auto& axis : bench.drives.axis) axis.says_position = true;
  bench.expect_latched(Fault::kDeviceLost);
}

TEST(OdriveFaults, AShortGapFadesAndComesBackWithoutAStep) {
  Bench bench;
  bench.run();
  bench.tick();
  const auto full_Nm = static_cast<double>(bench.drives.axis[0].torque_Nm);
  bench.drives.axis[2].says_position = false;
  bench.tick();  // 1.1 ms old is still fresh
  for (int i = 0; i < 6; ++i) ASSERT_EQ(bench.tick(), Fault::kNone);
  EXPECT_NEAR(static_cast<double>(bench.drives.axis[0].torque_Nm), 0.5 * full_Nm, 1e-6);
  bench.drives.axis[2].says_position = true;
  for (int i = 6; i <= 10; ++i) {
    bench.tick();
    EXPECT_NEAR(static_cast<double>(bench.drives.axis[0].torque_Nm), 0.1 * i * full_Nm, 1e-6);
  }
  bench.tick();
  EXPECT_NEAR(static_cast<double>(bench.drives.axis[0].torque_Nm), full_Nm, 1e-6);
}

TEST(OdriveFaults, ADriveThatNeverEntersClosedLoopIsNamed) {
  Bench bench;
  ASSERT_EQ(bench.open(&start_odrive_delta), "");
  bench.drives.axis[0].obeys = false;
  const int ticks = bench.ticks_until(Fault::kDriveFault, 4000);
  EXPECT_GT(ticks, 2900);
  EXPECT_LT(ticks, 3100);
  EXPECT_TRUE(bench.says("arm 1 (node 1 on can0): the drive does not enter closed loop"))
      << bench.device->fault_detail();
  EXPECT_FALSE(bench.device->ready());
}

TEST(OdriveFaults, AWatchdogThatExpiredBeforeTheLoopIsClearedOnce) {
  Bench bench;
  ASSERT_EQ(bench.open(&start_odrive_delta), "");
  bench.drives.forget();
  for (auto& axis : bench.drives.axis) axis.error = 0x1000000;
  bench.loop();
  for (const auto& axis : bench.drives.axis) bench.drives.say_heartbeat(axis);
  EXPECT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(bench.drives.times(i, kClearErrors), 1);
  bench.drives.axis[0].error = 0x1000000;
  bench.drives.say_heartbeat(bench.drives.axis[0]);
  EXPECT_EQ(bench.tick(), Fault::kDriveFault) << "while it runs, it is a fault";
}

TEST(OdriveFaults, PassiveAndOffLatchEvenIfTheBusComesBack) {
  constexpr struct {
    std::uint32_t classes;
    std::uint8_t controller;
    const char* words;
  } kCases[] = {{0x004, 0x10, "Too many receive errors"},
                {0x004, 0x20, "Too many transmit errors"},
                {0x040, 0x00, "left the bus"},
                {0x100, 0x00, "came back onto the bus"}};
  for (const auto& one : kCases) {
    Bench bench;
    bench.run();
    bench.drives.bus.say_error(one.classes, one.controller);
    EXPECT_EQ(bench.tick(), Fault::kBusOff);
    bench.expect_stopped();
    EXPECT_TRUE(bench.says(one.words)) << bench.device->fault_detail();
    bench.drives.bus.say_error(0x104, 0x40);  // restarted, active again
    bench.expect_latched(Fault::kBusOff);
  }
}

TEST(OdriveFaults, AWarningIsNoFault) {
  Bench bench;
  bench.run();
  bench.drives.bus.say_error(0x004, 0x0C);
  bench.drives.bus.say_error(0x020, 0x00);
  EXPECT_EQ(bench.tick(), Fault::kNone);
  EXPECT_TRUE(bench.sample.fresh);
}

TEST(OdriveFaults, ALostInterfaceIsABusThatIsDown) {
  for (const int error : {ENETDOWN, ENXIO, ENODEV}) {
    Bench receiving, sending;
    receiving.run();
    receiving.drives.bus.socket().receive_error = error;
    EXPECT_EQ(receiving.tick(), Fault::kBusDown);
    EXPECT_TRUE(receiving.says("ip link set can0 up")) << receiving.device->fault_detail();
    receiving.expect_latched(Fault::kBusDown);
    sending.run();
    sending.drives.bus.socket().send_error = error;
    EXPECT_EQ(sending.tick(), Fault::kBusDown);
    sending.expect_latched(Fault::kBusDown);
  }
}

TEST(OdriveFaults, AFullQueueIsAMissedCycleAndNeverRepeated) {
  for (const int error : {ENOBUFS, EAGAIN}) {
    Bench bench;
    bench.run();
    bench.drives.bus.socket().send_error = error;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(bench.tick({0.0, 0.0, 9.0}), Fault::kNone);
    bench.drives.bus.socket().send_error = 0;
    bench.drives.forget();
    EXPECT_EQ(bench.tick(), Fault::kNone);
    EXPECT_EQ(bench.drives.times(0, kSetInputTorque), 1) << "the new one alone";
    EXPECT_EQ(bench.count("missed_cycles"), 3u);
  }
}

TEST(OdriveFaults, ABusThatTakesNothingForTwentyTicksIsDown) {
  Bench bench;
  bench.run();
  bench.drives.bus.socket().send_error = ENOBUFS;
  EXPECT_EQ(bench.ticks_until(Fault::kBusDown, 100), 20);
  EXPECT_TRUE(bench.says("took no frames")) << bench.device->fault_detail();
}

TEST(OdriveFaults, ArmsBeyondTheirStopsAreALostHoming) {
  Bench bench;
  bench.run();
  auto& axis = bench.drives.axis[2];
  axis.turns_per_s = 20.0;
  EXPECT_GT(bench.ticks_until(Fault::kHomingLost, 2000), 0);
  EXPECT_TRUE(bench.says("arm 3 would be at 97 degrees")) << bench.device->fault_detail();
  bench.expect_stopped();
}

TEST(OdriveFaults, TheFirstFaultIsTheReportedOne) {
  Bench bench;
  bench.run();
  bench.drives.axis[1].error = 0x200;
  bench.drives.say_heartbeat(bench.drives.axis[1]);
  bench.tick();
  bench.drives.bus.say_error(0x040, 0);
  EXPECT_EQ(bench.tick(), Fault::kDriveFault);
  EXPECT_TRUE(bench.says("DC bus voltage too low"));
}

TEST(OdriveFaults, AMotorSupplyThatIsOffAtTheStartIsWaitedFor) {
  for (const bool v06 : {true, false}) {
    Bench bench(v06);
    for (auto& one : bench.drives.axis) one.no_supply = true, one.turns = 0.1;
    ASSERT_EQ(bench.open(&start_odrive_delta), "");
    for (int i = 0; i < 8000; ++i) {
      ASSERT_EQ(bench.tick(), Fault::kNone) << i << ": " << bench.device->fault_detail();
      ASSERT_FALSE(bench.device->ready());
    }
    EXPECT_NE(bench.device->fault_detail().find("waiting for power of arm "), std::string::npos);
    EXPECT_NE(bench.device->fault_detail().find("motor supply is too low"), std::string::npos);
    for (auto& one : bench.drives.axis) one.no_supply = false;
    EXPECT_GT(bench.ticks_until_ready(2000), 0) << bench.device->fault_detail();
    EXPECT_EQ(bench.device->fault_detail(), "");
  }
}

TEST(OdriveFaults, AMotorSupplyThatGoesAfterAForceIsAFault) {
  Bench bench;
  bench.run();
  bench.drives.axis[1].error = 0x200;
  bench.drives.axis[1].state = 1;
  Fault fault = Fault::kNone;
  for (int i = 0; i < 200 && fault == Fault::kNone; ++i) fault = bench.tick({0.0, 0.0, 1.0});
  EXPECT_EQ(fault, Fault::kDriveFault);
}

}  // namespace tact::hal::odrive::odrive_faults_test
