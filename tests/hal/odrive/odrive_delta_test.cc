// SPDX-License-Identifier: Apache-2.0
// The running device; opening it is in odrive_bring_up_test.cc.
#include "hal/odrive/odrive_delta.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hal/can/can_settings.h"
#include "tests/hal/odrive/odrive_drives.h"
#include "tests/support/can_bench.h"

namespace tact::hal::odrive::odrive_delta_test {

using tests::jig_settings;
using tests::published_pose;
using enum OdriveCommand;

struct Bench : tests::CanBench<tests::PlayedOdrives> {
  Bench() : CanBench(jig_settings(published_pose())) {
    double turns = 0.37;
    for (auto& axis : drives.axis) axis.turns = turns += 1.0;  // wherever the encoders began
  }
  std::string open() { return CanBench::open(&start_odrive_delta); }
  /// Open and holding.
  void run() {
    ASSERT_EQ(open(), "");
    ASSERT_GT(ticks_until_ready(), 0) << device->fault_detail();
    drives.forget();
  }
  bool all_off() const {
    return std::all_of(drives.axis.begin(), drives.axis.end(),
                       [](const auto& axis) { return axis.state == 1 && axis.torque_Nm == 0.0f; });
  }
};

TEST(OdriveDelta, IsReadyWhenAllThreeHeartbeatsSayClosedLoop) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  bench.drives.axis[2].obeys = false;
  EXPECT_EQ(bench.ticks_until_ready(300), -1);
  EXPECT_EQ(bench.fresh_ticks, 300) << "where it is can be known without power";
  bench.drives.axis[2].obeys = true;  // the request is repeated
  EXPECT_GT(bench.ticks_until_ready(300), 0);
}

// Opening takes longer than a tick: its frames are in the kernel's queue when the loop begins.
TEST(OdriveDelta, FramesFromBeforeTheLoopAreTakenBeforeTheFirstTick) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  for (int i = 0; i < 50; ++i) bench.drives.millisecond();
  bench.device->catch_up(bench.now_ns);
  EXPECT_EQ(bench.loop(), Fault::kNone);
  EXPECT_FALSE(bench.sample.fresh) << "nothing is left";
  EXPECT_EQ(bench.count("cut_reads"), 0u);
  EXPECT_EQ(bench.tick(), Fault::kNone);
  EXPECT_TRUE(bench.sample.fresh);
}

TEST(OdriveDelta, LowerBitRateIncreasesTheReportedDelay) {
  Bench fast, slow;
  slow.drives.bus.connect({.slow_bps = 500'000});
  ASSERT_EQ(fast.open(), "");
  ASSERT_EQ(slow.open(), "");
  const double cycle_s = odrive_cycle_bits(fast.settings.of<OdriveSettings>()) / 1e6;
  EXPECT_NEAR(fast.device->info().at_tool->delay_s, 1e-3 + cycle_s, 1e-12);
  EXPECT_NEAR(slow.device->info().at_tool->delay_s, 1e-3 + 2.0 * cycle_s, 1e-12);
}

TEST(OdriveDelta, SendsZeroTorqueBeforeItAsksForPower) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  bench.drives.forget();
  for (int i = 0; i < 20; ++i) bench.tick({1.0, 2.0, 3.0});
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& heard = bench.drives.axis[i].heard;
    const auto power = std::find(heard.begin(), heard.end(), kSetAxisState);
    ASSERT_NE(power, heard.end());
    EXPECT_GE(std::count(heard.begin(), power, kSetInputTorque), 5);
    EXPECT_EQ(bench.drives.times(i, kSetInputTorque), 20);
    EXPECT_EQ(bench.drives.axis[i].torque_Nm, 0.0f);
  }
}

TEST(OdriveDelta, NothingHasPowerWithoutPermission) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  bench.permitted = false;
  for (int i = 0; i < 500; ++i) ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone);
  EXPECT_TRUE(bench.all_off());
  EXPECT_FALSE(bench.device->ready());
  EXPECT_EQ(bench.fresh_ticks, 500);
}

TEST(OdriveDelta, PermissionThatComesBackBringsZeroTorqueFirst) {
  Bench bench;
  bench.run();
  for (int press = 0; press < 2; ++press) {
    bench.tick({0.0, 0.0, 5.0});
    EXPECT_NE(bench.drives.axis[0].torque_Nm, 0.0f);
    bench.permitted = false;
    for (int i = 0; i < 500; ++i) {
      ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone) << bench.device->fault_detail();
      ASSERT_TRUE(bench.all_off()) << "from the tick of the withdrawal on";
      ASSERT_FALSE(bench.device->ready());
      ASSERT_TRUE(bench.sample.fresh);
    }
    bench.permitted = true;
    int starting = 0;
    for (; starting < 300 && !bench.device->ready(); ++starting) {
      for (const auto& axis : bench.drives.axis) ASSERT_EQ(axis.torque_Nm, 0.0f);
      ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone) << bench.device->fault_detail();
    }
    EXPECT_GT(starting, 5) << "zero torque first, then closed loop";
    EXPECT_LT(starting, 300);
  }
}

TEST(OdriveDelta, ForceBecomesTheTorquesOfTheStatics) {
  Bench bench;
  bench.run();
  const Vec3 force{1.0, -2.0, 3.0};
  ASSERT_EQ(bench.tick(force), Fault::kNone);
  const auto wanted = tests::expected_motor_Nm(bench.settings, published_pose(), force);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(static_cast<double>(bench.drives.axis[i].torque_Nm), wanted[i], 1e-6);
}

TEST(OdriveDelta, ThePoseIsThatOfTheArms) {
  Bench bench;
  bench.run();
  const Vec3 p_D = published_pose().position_D_m;
  EXPECT_NEAR(bench.sample.tool.position_m.x, p_D.z - 0.345, 1e-6);
  EXPECT_NEAR(bench.sample.tool.position_m.y, -p_D.y, 1e-6);
  EXPECT_NEAR(bench.sample.tool.position_m.z, p_D.x, 1e-6);
  EXPECT_LT(norm(bench.sample.tool.velocity_mps), 1e-9);
  EXPECT_EQ(bench.sample.stamp_ns, bench.now_ns - 100'000);
}

TEST(OdriveDelta, SaturationKeepsTheDirectionOfTheForce) {
  Bench bench;
  bench.settings.of<can::DeltaSettings>().max_joint_torque_Nm = 2.0;
  bench.run();
  const Vec3 force{-6.0, 8.0, 12.0};
  bench.tick(force);
  const auto pose = published_pose();
  const auto none = tests::expected_motor_Nm(bench.settings, pose, {});
  const auto full = tests::expected_motor_Nm(bench.settings, pose, force);
  double largest_Nm = 0.0, ratio = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto torque_Nm = static_cast<double>(bench.drives.axis[i].torque_Nm);
    largest_Nm = std::max(largest_Nm, std::abs(torque_Nm));
    const double here = (torque_Nm - none[i]) / (full[i] - none[i]);
    if (i > 0) EXPECT_NEAR(here, ratio, 1e-5);
    ratio = here;
  }
  EXPECT_NEAR(largest_Nm, 0.2, 1e-6);  // 2 N m at the arm, 10:1
  EXPECT_GT(ratio, 0.0);
  EXPECT_LT(ratio, 1.0);
}

TEST(OdriveDelta, NanForceIsAFaultAndLeavesGravityTorqueOnly) {
  Bench bench;
  bench.run();
  EXPECT_EQ(bench.tick({std::nan(""), 0.0, 0.0}), Fault::kForceNotFinite);
  const auto none = tests::expected_motor_Nm(bench.settings, published_pose(), {});
  EXPECT_NEAR(static_cast<double>(bench.drives.axis[0].torque_Nm), none[0], 1e-6);
}

TEST(OdriveDelta, ATickTakesTwoSystemCallsAndNoHeap) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  for (int i = 0; i < 400; ++i) {
    bench.tick({1.0, 0.0, 0.0});
    ASSERT_EQ(bench.system_calls, 2);
  }
  EXPECT_EQ(bench.allocations, 0u);
  EXPECT_GT(bench.fresh_ticks, 100);
}

TEST(OdriveDelta, OneLateFrameIsNoGapButTwoAre) {
  Bench bench;
  bench.run();
  bench.drives.axis[1].says_position = false;
  bench.tick();
  EXPECT_TRUE(bench.sample.fresh) << "1.1 ms old: drives have their own clocks";
  bench.tick();
  EXPECT_FALSE(bench.sample.fresh);
  bench.drives.axis[1].says_position = true;
  bench.tick();
  EXPECT_TRUE(bench.sample.fresh);
}

TEST(OdriveDelta, WithoutAnyNewPositionNothingIsFresh) {
  Bench bench;
  bench.run();
  const auto sequence = bench.sample.sequence;
  for (auto& axis : bench.drives.axis) axis.says_position = false;
  EXPECT_EQ(bench.tick(), Fault::kNone);
  EXPECT_FALSE(bench.sample.fresh);
  EXPECT_EQ(bench.sample.sequence, sequence);
}

TEST(OdriveDelta, OldFramesAreNotFresh) {
  Bench bench;
  bench.run();
  bench.drives.bus.socket().age_ns = 5'000'000;  // they lay in the queue
  bench.tick();
  EXPECT_FALSE(bench.sample.fresh);
}

TEST(OdriveDelta, TheLastFrameAgainIsNoNewsWhileTheMotorTurns) {
  Bench bench;
  bench.run();
  for (auto& axis : bench.drives.axis) axis.turns_per_s = 0.5;
  for (int i = 0; i < 5; ++i) bench.tick();
  ASSERT_TRUE(bench.sample.fresh);
  const auto frozen = bench.drives.axis[0];
  bench.drives.axis[0].says_position = false;
  for (int i = 0; i < 3; ++i) {
    bench.drives.millisecond();
    bench.drives.say_position(frozen);
    ASSERT_EQ(bench.loop(), Fault::kNone);
  }
  EXPECT_FALSE(bench.sample.fresh);
  EXPECT_EQ(bench.count("stale"), 3u);
}

TEST(OdriveDelta, APositionThatJumpsIsNotTakenAndThriceIsALostHoming) {
  Bench bench;
  bench.run();
  bench.drives.axis[1].turns += 0.5;  // 18 degrees of the arm in a millisecond, at rest
  EXPECT_EQ(bench.tick(), Fault::kNone);
  EXPECT_EQ(bench.tick(), Fault::kNone);
  EXPECT_EQ(bench.tick(), Fault::kHomingLost);
  EXPECT_NE(bench.device->fault_detail().find("arm 2 (node 2 on can0): its position jumped"),
            std::string::npos);
  EXPECT_TRUE(bench.all_off());
}

TEST(OdriveDelta, TwoDrivesWithOneNodeIdLatch) {
  Bench bench;
  bench.run();
  auto other = bench.drives.axis[1];
  other.turns += 0.5;
  int ticks = 1;
  for (; ticks < 20; ++ticks) {
    bench.drives.say_position(other);
    if (bench.tick() != Fault::kNone) break;
  }
  EXPECT_LE(ticks, 5);
  EXPECT_NE(bench.device->fault_detail().find("two drives share a node"), std::string::npos);
  EXPECT_TRUE(bench.all_off());
}

TEST(OdriveDelta, FramesOfOtherNodesChangeNothing) {
  Bench bench;
  bench.run();
  auto stranger = bench.drives.axis[0];
  stranger.node = 9;
  stranger.turns += 0.3;
  bench.drives.say_position(stranger);
  bench.tick();
  EXPECT_TRUE(bench.sample.fresh);
  EXPECT_EQ(bench.count("strays"), 1u);
  const auto counters = bench.device->counters();
  ASSERT_FALSE(counters.empty());
  EXPECT_STREQ(counters[0].name, "strays");
  EXPECT_EQ(counters[0].count, 1u);
}

TEST(OdriveDelta, NothingIsSentAfterStop) {
  Bench bench;
  bench.run();
  bench.tick({0.0, 0.0, 4.0});
  bench.device->stop();
  bench.drives.listen();
  EXPECT_TRUE(bench.all_off());
  bench.drives.forget();
  bench.device->stop();
  for (int i = 0; i < 10; ++i) bench.tick({0.0, 0.0, 4.0});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(bench.drives.axis[i].heard.empty());
}

}  // namespace tact::hal::odrive::odrive_delta_test
