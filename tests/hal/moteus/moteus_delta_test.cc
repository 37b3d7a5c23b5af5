// SPDX-License-Identifier: Apache-2.0
// The running device; its opening and its faults have files of their own.
#include "hal/moteus/moteus_delta.h"

#include <gtest/gtest.h>

#include "hal/can/can_settings.h"
#include "hal/moteus/moteus_bring_up.h"
#include "hal/moteus/moteus_protocol.h"
#include "tests/hal/moteus/moteus_bench.h"

namespace tact::hal::moteus::moteus_delta_test {

using tests::MoteusBench;
using tests::published_pose;

TEST(MoteusDelta, IsReadyWhenAllAreInPositionModeWithoutEarlierTorque) {
  MoteusBench bench({.prepare_ms = 40});
  ASSERT_EQ(bench.open(), "");
  int ticks = 0;
  for (; ticks < 300 && !bench.device->ready(); ++ticks) {
    ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone) << bench.device->fault_detail();
    if (!bench.device->ready()) EXPECT_EQ(bench.drives.largest_torque_Nm, 0.0);
  }
  EXPECT_GT(ticks, 50) << "40 ms to prepare, ten replies without torque";
  EXPECT_LT(ticks, 60);
}

TEST(MoteusDelta, LowerBitRateIncreasesTheReportedDelay) {
  MoteusBench fast, slow;
  slow.drives.connect_again({.slow_bps = 1e6, .fast_bps = 2e6});
  ASSERT_EQ(fast.open(), "");
  ASSERT_EQ(slow.open(), "");
  const can::CanFdBits bits = moteus_cycle_bits(fast.settings.of<can::CanSettings>());
  EXPECT_NEAR(fast.device->info().at_tool->delay_s, 1e-3 + bits.slow / 1e6 + bits.fast / 5e6,
              1e-12);
  EXPECT_NEAR(slow.device->info().at_tool->delay_s, 1e-3 + bits.slow / 1e6 + bits.fast / 2e6,
              1e-12);
}

TEST(MoteusDelta, NothingHasPowerWithoutPermissionAndThePoseIsKnown) {
  MoteusBench bench;
  ASSERT_EQ(bench.open(), "");
  bench.permitted = false;
  bench.tick();
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone);
    ASSERT_TRUE(bench.sample.fresh);
  }
  EXPECT_EQ(bench.drives.most_enabled, 0u);
  EXPECT_FALSE(bench.device->ready());
}

TEST(MoteusDelta, WithdrawnPermissionStopsAtOnceAndReturnsWithoutTorque) {
  MoteusBench bench;
  bench.run();
  for (int press = 0; press < 2; ++press) {
    bench.tick({0.0, 0.0, 5.0});
    EXPECT_NE(bench.axis(0).torque_Nm(), 0.0);
    bench.permitted = false;
    for (int i = 0; i < 50; ++i) {
      ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone) << bench.device->fault_detail();
      ASSERT_TRUE(bench.all_stopped()) << "from the tick of the withdrawal on";
    }
    bench.permitted = true;
    bench.drives.largest_torque_Nm = 0.0;
    while (!bench.device->ready()) {
      EXPECT_EQ(bench.drives.largest_torque_Nm, 0.0);
      ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone) << bench.device->fault_detail();
    }
  }
}

TEST(MoteusDelta, ForceBecomesTheTorquesOfTheStaticsForAnyGainsOfTheDrive) {
  MoteusBench bench({.kp_Nm = 20.0, .kd_Nms = 3.0});
  bench.run();
  for (auto& motor : bench.drives.motor) motor.velocity_turns_per_s = 0.5;
  const Vec3 force{1.0, -2.0, 3.0};
  ASSERT_EQ(bench.tick(force), Fault::kNone);
  const auto wanted = tests::expected_motor_Nm(bench.settings, published_pose(), force);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(bench.axis(i).torque_Nm(), wanted[i], 1e-6);
}

TEST(MoteusDelta, ThePoseIsThatOfTheArms) {
  MoteusBench bench;
  bench.run();
  const Vec3 p_D = published_pose().position_D_m;
  EXPECT_NEAR(bench.sample.tool.position_m.x, p_D.z - 0.345, 1e-6);
  EXPECT_NEAR(bench.sample.tool.position_m.y, -p_D.y, 1e-6);
  EXPECT_NEAR(bench.sample.tool.position_m.z, p_D.x, 1e-6);
  EXPECT_LT(norm(bench.sample.tool.velocity_mps), 1e-9);
  EXPECT_EQ(bench.sample.stamp_ns, bench.now_ns - 100'000);
}

TEST(MoteusDelta, TheSampleHasTheTemperatureThatDrivesReport) {
  MoteusBench bench;
  bench.run();
  bench.tick();
  EXPECT_EQ(bench.sample.temperature_C, bench.axis(0).get(0x00E));
}

TEST(MoteusDelta, TorqueIsLimitedByTheSceneAndKeepsTheForceDirection) {
  MoteusBench bench;
  bench.settings.of<can::DeltaSettings>().max_joint_torque_Nm = 2.0;
  bench.run();
  const Vec3 force{-6.0, 8.0, 12.0};
  bench.tick(force);
  const auto none = tests::expected_motor_Nm(bench.settings, published_pose(), {});
  const auto full = tests::expected_motor_Nm(bench.settings, published_pose(), force);
  double largest_Nm = 0.0, ratio = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double torque_Nm = bench.axis(i).torque_Nm();
    largest_Nm = std::max(largest_Nm, std::abs(torque_Nm));
    const double here = (torque_Nm - none[i]) / (full[i] - none[i]);
    if (i > 0) EXPECT_NEAR(here, ratio, 1e-5);
    ratio = here;
  }
  EXPECT_NEAR(largest_Nm, 0.2, 1e-6);  // 2 N m at the arm, 10:1
}

TEST(MoteusDelta, NanForceIsAFaultAndLeavesGravityTorqueOnly) {
  MoteusBench bench;
  bench.run();
  EXPECT_EQ(bench.tick({std::nan(""), 0.0, 0.0}), Fault::kForceNotFinite);
  const auto none = tests::expected_motor_Nm(bench.settings, published_pose(), {});
  EXPECT_NEAR(bench.axis(0).torque_Nm(), none[0], 1e-6);
}

TEST(MoteusDelta, ATickTakesTwoSystemCallsAndNoHeap) {
  MoteusBench bench;
  ASSERT_EQ(bench.open(), "");
  for (int i = 0; i < 400; ++i) {
    bench.tick({1.0, 0.0, 0.0});
    ASSERT_EQ(bench.system_calls, 2);
  }
  EXPECT_EQ(bench.allocations, 0u);
  EXPECT_GT(bench.fresh_ticks, 390) << "each command brings the position of the next tick";
}

TEST(MoteusDelta, AHostThatFallsSilentIsEndedByTheDrivesAfterTenMilliseconds) {
  for (const int timeout_mode : {0, 12}) {
    MoteusBench bench({.timeout_mode = timeout_mode});
    bench.run();
    bench.tick({0.0, 0.0, 5.0});
    for (int i = 0; i < 8; ++i) bench.drives.millisecond();
    EXPECT_NE(bench.axis(0).torque_Nm(), 0.0);
    for (int i = 0; i < 3; ++i) bench.drives.millisecond();
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_FALSE(bench.axis(i).is_enabled());
      EXPECT_EQ(bench.axis(i).torque_Nm(), 0.0);
    }
    // The host wakes: nothing comes back by itself, and it says why.
    EXPECT_EQ(bench.ticks_until(Fault::kDriveFault, 3), 2);
    EXPECT_TRUE(bench.says("arm 1 (node 1 on can0): its watchdog expired"))
        << bench.device->fault_detail();
    EXPECT_TRUE(bench.all_stopped());
  }
}

TEST(MoteusDelta, AKilledRunLeavesDrivesThatTheNextOneTakesUp) {
  MoteusBench bench;
  bench.run();
  bench.tick({0.0, 0.0, 5.0});
  bench.drives.bus.socket().send_error = ENOBUFS;  // killed: nothing more of it reaches a drive
  bench.device.reset();
  for (int i = 0; i < 100; ++i) bench.drives.millisecond();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(bench.axis(i).mode(), 11) << "its watchdog";
  bench.drives.connect_again();
  bench.drives.most_enabled = 0;
  ASSERT_EQ(bench.open(), "");
  EXPECT_EQ(bench.drives.most_enabled, 0u);
  ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
}

TEST(MoteusDelta, ShutdownFramesAreStopCommandsForAllThreeDrives) {
  MoteusBench bench;
  ASSERT_EQ(bench.open(), "");
  const auto words = bench.device->shutdown_frames();  // before the loop, as tactd asks for them
  ASSERT_TRUE(words);
  EXPECT_EQ(words->count, 6u);
  for (std::size_t i = 0; i < words->count; ++i) {
    const auto frame = can::unpack_can_fd_frame(words->bytes_of(i));
    ASSERT_TRUE(frame);
    EXPECT_EQ(*frame, *moteus_stop(moteus_address(*frame).destination));
  }
  ASSERT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();
  for (int i = 0; i < 3; ++i) bench.tick({0.0, 0.0, 4.0});
  ASSERT_NE(bench.axis(0).torque_Nm(), 0.0);
  bench.drives.expect_freed_by(*words);
}

TEST(MoteusDelta, ALoopThatIsSlowerThanTheWatchdogAllowsIsRefused) {
  MoteusBench bench;
  auto opened = start_moteus_delta(bench.drives.bus.bus(), bench.settings, 400.0);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("use 500 or more"), std::string::npos);
}

}  // namespace tact::hal::moteus::moteus_delta_test
