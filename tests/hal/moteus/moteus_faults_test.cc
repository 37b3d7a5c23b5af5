// SPDX-License-Identifier: Apache-2.0
// Every fault of a moteus delta: seen, named, latched, and no torque after it.
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <memory>

#include "hal/moteus/moteus_protocol.h"
#include "tests/hal/moteus/moteus_bench.h"

namespace tact::hal::moteus::moteus_faults_test {

/// Two drives with one node id, each with its own motor. The second is powered later.
struct SharedNode final : rig::Drive {
  SharedNode(int axis, int node, const rig::MoteusSettings& settings, rig::CanBus& bus,
             const rig::Motor& motor, const rig::FaultPlan& plan)
      : first(axis, node, settings, bus, motor, plan),
        second(axis, node, settings, bus, second_motor, plan) {}
  bool receive(const canfd_frame& frame, std::int64_t now_ns) override {
    const bool obeys = first.receive(frame, now_ns);
    return (powered && second.receive(frame, now_ns)) || obeys;
  }
  void tick(std::int64_t now_ns) override {
    first.tick(now_ns);
    second.tick(now_ns);
  }
  void fail(std::int64_t now_ns) override { first.fail(now_ns); }
  bool warn(std::int64_t) override { return false; }
  bool is_enabled() const override { return first.is_enabled() || second.is_enabled(); }
  double torque_Nm() const override { return first.torque_Nm() + second.torque_Nm(); }
  bool tripped() override { return first.tripped() || second.tripped(); }

  rig::Motor second_motor{.position_turns = 0.2};
  rig::MoteusDrive first, second;
  bool powered = false;
};

struct Bench : tests::MoteusBench {
  using MoteusBench::MoteusBench;
  /// The fault stays, for all further behaviour of bus and drives; the hand has no force.
  void expect_latched(Fault fault) {
    drives.bus.socket().send_error = drives.bus.socket().receive_error = 0;
    for (int i = 0; i < 100; ++i) {
      ASSERT_EQ(tick({0.0, 0.0, 5.0}), fault);
      ASSERT_FALSE(sample.fresh);
      for (const auto& drive : drives.drive) ASSERT_EQ(drive->torque_Nm(), 0.0);
    }
    EXPECT_EQ(allocations, 0u);
  }
};

TEST(MoteusFaults, ADrivesFaultIsReportedAsTextAndStopsAllThree) {
  Bench bench;
  bench.run();
  bench.tick({0.0, 0.0, 5.0});
  bench.drives.drive[1]->fail(bench.drives.now_ns);
  const int ticks = bench.ticks_until(Fault::kDriveFault, 5);
  EXPECT_TRUE(ticks == 1 || ticks == 2) << ticks;
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): The power stage reports a fault"))
      << bench.device->fault_detail();
  EXPECT_TRUE(bench.says("(fault 33)"));
  EXPECT_TRUE(bench.all_stopped());
  bench.expect_latched(Fault::kDriveFault);
}

TEST(MoteusFaults, ADriveThatCannotBeEnabledIsNamedWithItsReason) {
  Bench bench;
  bench.drives.install<rig::MoteusDrive>(2, rig::MoteusSettings{.is_calibrated = false});
  ASSERT_EQ(bench.open(), "");
  const int ticks = bench.ticks_until(Fault::kDriveFault, 100);
  EXPECT_GT(ticks, 0);
  EXPECT_TRUE(bench.says("arm 3 (node 3 on can0): The motor is not configured"))
      << bench.device->fault_detail();
  EXPECT_FALSE(bench.device->ready());
}

TEST(MoteusFaults, ASupplyThatIsTooLowAtTheStartIsWaitedFor) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  bench.axis(1).sag(true);
  int asked = 0;
  for (int i = 0, before = 1; i < 8000; ++i) {
    ASSERT_EQ(bench.tick(), Fault::kNone) << i << ": " << bench.device->fault_detail();
    ASSERT_FALSE(bench.device->ready());
    for (const auto& drive : bench.drives.drive) ASSERT_EQ(drive->torque_Nm(), 0.0);
    const int mode = bench.axis(1).mode();
    asked += mode != before && mode == 0 ? 1 : 0;
    before = mode;
  }
  EXPECT_TRUE(bench.says("waiting for power of arm 2 (node 2 on can0): DC bus voltage too low"))
      << bench.device->fault_detail();
  EXPECT_GE(asked, 7) << "once a second";
  EXPECT_LE(asked, 9);
  bench.axis(1).sag(false);
  EXPECT_GT(bench.ticks_until_ready(1500), 0) << bench.device->fault_detail();
  EXPECT_EQ(bench.device->fault_detail(), "");
  EXPECT_EQ(bench.allocations, 0u);
}

TEST(MoteusFaults, AFaultIsReportedWhileAnEarlierArmWaitsForItsSupply) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  bench.axis(0).sag(true);
  for (int i = 0; i < 100; ++i) bench.tick();  // past the first time that it is asked again
  ASSERT_TRUE(bench.says("waiting for power of arm 1")) << bench.device->fault_detail();
  bench.drives.drive[1]->fail(bench.drives.now_ns);
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 5), 0) << bench.device->fault_detail();
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): The power stage reports a fault"))
      << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(MoteusFaults, ASupplyThatSagsBeforeAnyForceIsWaitedForAndAfterOneIsAFault) {
  Bench bench;
  bench.run();
  bench.axis(2).sag(true);
  for (int i = 0; i < 20; ++i)
    ASSERT_EQ(bench.tick(), Fault::kNone) << bench.device->fault_detail();
  EXPECT_FALSE(bench.device->ready());
  bench.axis(2).sag(false);
  ASSERT_GT(bench.ticks_until_ready(1500), 0) << bench.device->fault_detail();
  bench.tick({0.0, 0.0, 5.0});
  bench.axis(2).sag(true);
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 20), 0);
  EXPECT_TRUE(bench.says("arm 3 (node 3 on can0): DC bus voltage too low"));
  bench.axis(2).sag(false);
  bench.expect_latched(Fault::kDriveFault);
}

TEST(MoteusFaults, ADriveThatNeverGetsReadyIsNamedAfterThreeSeconds) {
  Bench bench;
  bench.drives.install<rig::MoteusDrive>(0, rig::MoteusSettings{.prepare_ms = 100'000});
  ASSERT_EQ(bench.open(), "");
  const int ticks = bench.ticks_until(Fault::kDriveFault, 4000);
  EXPECT_GT(ticks, 2900);
  EXPECT_LT(ticks, 3100);
  EXPECT_TRUE(
      bench.says("arm 1 (node 1 on can0): the drive does not enter position mode and is "
                 "preparing"))
      << bench.device->fault_detail();
}

TEST(MoteusFaults, ADriveWithATorqueOfItsOwnNeverGetsReady) {
  // The integral term of its position loop, with a gain that acts at once.
  Bench bench;
  bench.drives.install<rig::MoteusDrive>(
      1, rig::MoteusSettings{.integral_gain_Nm_per_turn_s = 1e6, .integral_limit_Nm = 0.5});
  ASSERT_EQ(bench.open(), "");
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 4000), 0);
  EXPECT_TRUE(
      bench.says("arm 2 (node 2 on can0): the drive gives -0.50 N m that was not commanded: set "
                 "servo.pid_position.ki"))
      << bench.device->fault_detail();
}

TEST(MoteusFaults, ATorqueThatGrowsSlowlyIsAFaultOfAReadyDrive) {
  Bench bench;
  bench.drives.install<rig::MoteusDrive>(
      1, rig::MoteusSettings{.integral_gain_Nm_per_turn_s = 2.0, .integral_limit_Nm = 1.0});
  bench.run();
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 4000), 0);
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): the drive gives"))
      << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(MoteusFaults, GravityAndForceAreNoUncommandedTorque) {
  Bench bench;
  bench.run();
  for (int i = 0; i < 500; ++i) bench.tick();
  EXPECT_TRUE(bench.device->ready()) << bench.device->fault_detail();
}

TEST(MoteusFaults, ADriveThatAnotherHostStopsIsAFault) {
  Bench bench;
  bench.run();
  canfd_frame frame{};
  const auto bytes = can::pack_can_frame(*moteus_stop(3));
  std::copy(bytes->begin(), bytes->end(), reinterpret_cast<std::uint8_t*>(&frame));
  bench.drives.drive[2]->receive(frame, bench.drives.now_ns);
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 5), 0);
  EXPECT_TRUE(bench.says("arm 3 (node 3 on can0): the drive left position mode"))
      << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(MoteusFaults, TorquesFadeWithoutRepliesAndTheDeviceIsLostAfterTwenty) {
  Bench bench;
  bench.run();
  bench.tick();
  const double full_Nm = bench.axis(0).torque_Nm();
  ASSERT_NE(full_Nm, 0.0) << "gravity";
  bench.drives.drive[1] = std::make_unique<tests::DeadDrive>();
  bench.tick();  // its last reply was on the way
  for (int missing = 1; missing < 20; ++missing) {
    ASSERT_EQ(bench.tick(), Fault::kNone) << missing;
    const double ratio = missing == 1 ? 1.0 : std::max(0.0, (11 - missing) / 10.0);
    EXPECT_NEAR(bench.axis(0).torque_Nm(), ratio * full_Nm, 1e-6) << missing;
  }
  EXPECT_EQ(bench.tick(), Fault::kDeviceLost);
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): no reply for 20 ms"))
      << bench.device->fault_detail();
  bench.expect_latched(Fault::kDeviceLost);
}

TEST(MoteusFaults, RepliesThatLackWhatWasAskedForAreNoSamplesAndTenAreAFault) {
  Bench bench;
  bench.run();
  bench.tick({0.0, 0.0, 5.0});
  bench.axis(0).lose_position();
  bench.tick();
  bench.tick();
  EXPECT_FALSE(bench.sample.fresh);
  const int ticks = bench.ticks_until(Fault::kDriveFault, 20);
  EXPECT_GT(ticks, 7);
  EXPECT_LT(ticks, 12);
  EXPECT_TRUE(bench.says("arm 1 (node 1 on can0): its replies lack what was asked for"))
      << bench.device->fault_detail();
  EXPECT_EQ(bench.count("incomplete"), 10u);
}

TEST(MoteusFaults, AFaultIsReportedAlsoByADriveThatHasLostItsPosition) {
  Bench bench;
  bench.run();
  bench.axis(0).lose_position();
  bench.drives.drive[0]->fail(bench.drives.now_ns);
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 3), 0);
  EXPECT_TRUE(bench.says("(fault 33)")) << bench.device->fault_detail();
}

TEST(MoteusFaults, TwoDrivesWithOneNodeIdLatch) {
  Bench bench;
  bench.drives.install<SharedNode>(1, rig::MoteusSettings{});
  auto& both = static_cast<SharedNode&>(*bench.drives.drive[1]);
  both.second_motor = bench.drives.motor[1];  // nothing but the number of replies differs
  both.powered = true;
  ASSERT_EQ(bench.open(), "");
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 5), 0);
  EXPECT_TRUE(bench.says("two drives have this node id")) << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(MoteusFaults, ASecondDriveOfOneNodeIdThatIsPoweredLaterLatches) {
  Bench bench;
  bench.drives.install<SharedNode>(1, rig::MoteusSettings{});
  ASSERT_EQ(bench.open(), "");
  ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
  bench.tick({0.0, 0.0, 5.0});
  static_cast<SharedNode&>(*bench.drives.drive[1]).powered = true;
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 5), 0);
  EXPECT_TRUE(bench.says("or a second drive with this node id")) << bench.device->fault_detail();
  bench.expect_latched(Fault::kDriveFault);
}

TEST(MoteusFaults, TwoDrivesWithOneNodeIdAndOtherPositionsAreRefused) {
  Bench bench;
  bench.drives.install<SharedNode>(1, rig::MoteusSettings{});
  static_cast<SharedNode&>(*bench.drives.drive[1]).powered = true;
  bench.expect_refused("or two drives have this node id");
}

TEST(MoteusFaults, ABusThatGoesOffLatches) {
  Bench bench;
  bench.run();
  bench.drives.bus.socket().receive_error = ENETDOWN;
  EXPECT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kBusDown);
  EXPECT_TRUE(bench.says("dbitrate 5000000 sample-point 0.666")) << bench.device->fault_detail();
  bench.expect_latched(Fault::kBusDown);
}

TEST(MoteusFaults, OldRepliesAreNotFresh) {
  Bench bench;
  bench.run();
  bench.drives.bus.socket().age_ns = 5'000'000;  // they lay in the queue
  bench.tick();
  EXPECT_FALSE(bench.sample.fresh);
  EXPECT_GE(bench.count("old"), 3u);
}

TEST(MoteusFaults, ACommandOfAnotherSenderLatchesInTheTickThatHearsIt) {
  for (const int node : {1, 3, kMoteusAllNodes}) {
    for (const std::uint32_t source :
         {0u, 0x80u << 8, 5u << 8}) {  // as we are; with a reply; other
      Bench bench;
      bench.run();
      for (int i = 0; i < 20; ++i) ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone);
      ASSERT_EQ(bench.count("foreign_commands"), 0u) << "no false alarm";
      can::CanFdFrame frame = *moteus_torque(1, 0.7, 0.1);
      frame.id = source | static_cast<std::uint32_t>(node);
      const can::CanFdFrameBytes bytes = *can::pack_can_frame(frame);
      ASSERT_EQ(send(bench.drives.cable.descriptor(), bytes.data(), bytes.size(), 0), 72);
      EXPECT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kForeignCommand) << frame.id;
      EXPECT_TRUE(bench.says("a command that tactd did not send")) << bench.device->fault_detail();
      bench.expect_latched(Fault::kForeignCommand);
    }
  }
}

}  // namespace tact::hal::moteus::moteus_faults_test
