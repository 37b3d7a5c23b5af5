// SPDX-License-Identifier: Apache-2.0
// The running device; its faults are in cia402_faults_test.cc.
#include "hal/cia402/cia402_delta.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/hal/cia402/cia402_bench.h"

namespace tact::hal::cia402::cia402_delta_test {

using tests::published_pose;
using Bench = tests::Cia402Bench;

TEST(Cia402Delta, GoesToTorqueStepByStepInsideTheLoop) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  for (auto& axis : bench.drives.axis) {
    EXPECT_EQ(axis.status, 0x40) << "no power at opening";
    axis.controlwords.clear();
  }
  EXPECT_GT(bench.ticks_until_ready(50), 0) << bench.device->fault_detail();
  for (const auto& axis : bench.drives.axis) {
    EXPECT_EQ(axis.controlwords, (std::vector<std::uint16_t>{0x00, 0x06, 0x07, 0x0F}));
    EXPECT_EQ(axis.status, 0x27);
  }
}

TEST(Cia402Delta, LowerBitRateIncreasesTheReportedDelay) {
  Bench fast, slow;
  slow.drives.bus.connect({.slow_bps = 500'000});
  ASSERT_EQ(fast.open(), "");
  ASSERT_EQ(slow.open(), "");
  constexpr double kThreeCommands_s = 3 * 95e-6;
  EXPECT_NEAR(fast.device->info().at_tool->delay_s, 1e-3 + kThreeCommands_s, 1e-12);
  EXPECT_NEAR(slow.device->info().at_tool->delay_s, 1e-3 + 2.0 * kThreeCommands_s, 1e-12);
}

TEST(Cia402Delta, TorqueIsZeroUntilAllThreeAreEnabled) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  bench.drives.axis[2].obeys = false;
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone);
    for (const auto& axis : bench.drives.axis) ASSERT_EQ(axis.permille, 0);
  }
  EXPECT_EQ(bench.drives.axis[0].status, 0x27);
  EXPECT_FALSE(bench.device->ready());
  EXPECT_TRUE(bench.sample.fresh) << "where it is can be known without power";
}

TEST(Cia402Delta, ForceBecomesTheTorquesOfTheStatics) {
  Bench bench;
  bench.drives.axis[1].rated = 250;
  bench.run();
  const Vec3 force{1.0, -2.0, 3.0};
  ASSERT_EQ(bench.tick(force), Fault::kNone);
  const auto wanted = tests::expected_motor_Nm(bench.settings, published_pose(), force);
  for (std::size_t i = 0; i < 3; ++i) {
    const double half_step_Nm = 0.5e-6 * bench.drives.axis[i].rated;
    EXPECT_NEAR(bench.motor_Nm(i), wanted[i], half_step_Nm + 1e-6);
  }
  EXPECT_NEAR(bench.sample.tool.position_m.z, published_pose().position_D_m.x, 1e-6);
}

TEST(Cia402Delta, SyncIsTheLastFrameAndTheHostHeartbeatComesEvery5ms) {
  Bench bench;
  bench.run();
  bench.drives.host_heartbeats = 0;
  for (int i = 0; i < 100; ++i) {
    bench.drives.forget();
    bench.tick();
    ASSERT_EQ(bench.drives.heard.back().id, 0x080u);
    ASSERT_EQ(std::count_if(bench.drives.heard.begin(), bench.drives.heard.end(),
                            [](const can::CanFrame& frame) { return frame.id == 0x080; }),
              1);
  }
  EXPECT_EQ(bench.drives.host_heartbeats, 20);
}

TEST(Cia402Delta, ATickTakesTwoSystemCallsAndNoHeap) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  for (int i = 0; i < 100; ++i) {
    bench.tick({1.0, 0.0, 0.0});
    ASSERT_EQ(bench.system_calls, 2);
  }
  EXPECT_EQ(bench.allocations, 0u);
  EXPECT_GT(bench.fresh_ticks, 50);
}

TEST(Cia402Delta, OneMissingSampleMakesTheTickNotFresh) {
  Bench bench;
  bench.run();
  bench.drives.axis[1].says_sample = false;
  bench.tick();  // what SYNC asked for before is still heard
  EXPECT_EQ(bench.tick(), Fault::kNone);
  EXPECT_FALSE(bench.sample.fresh);
  bench.drives.axis[1].says_sample = true;
  bench.tick();
  bench.tick();
  EXPECT_TRUE(bench.sample.fresh);
}

TEST(Cia402Delta, SamplesOfAnOlderSyncAreDropped) {
  Bench bench;
  bench.run();
  bench.drives.bus.socket().age_ns = 3'000'000;
  bench.tick();
  EXPECT_FALSE(bench.sample.fresh);
  EXPECT_EQ(bench.count("old"), 3u);
}

TEST(Cia402Delta, ASecondSampleInATickIsCounted) {
  Bench bench;
  bench.run();
  bench.drives.say_sample(bench.drives.axis[0]);
  bench.tick();
  EXPECT_TRUE(bench.sample.fresh);
  EXPECT_EQ(bench.count("extra"), 1u);
}

TEST(Cia402Delta, WithoutPermissionTheDrivesLetGoAndComeBackWithItAtZeroTorque) {
  Bench bench;
  bench.run();
  bench.tick({0.0, 0.0, 5.0});
  for (int press = 0; press < 2; ++press) {
    bench.permitted = false;
    for (int i = 0; i < 100; ++i) {
      ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone) << bench.device->fault_detail();
      ASSERT_FALSE(bench.device->ready()) << "from the tick of the withdrawal on";
      ASSERT_TRUE(bench.sample.fresh);
      for (const auto& axis : bench.drives.axis) {
        ASSERT_EQ(axis.status, 0x40);
        ASSERT_EQ(axis.permille, 0);
      }
    }
    bench.permitted = true;
    int starting = 0;
    for (; starting < 50 && !bench.device->ready(); ++starting) {
      for (const auto& axis : bench.drives.axis) ASSERT_EQ(axis.permille, 0);
      ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone) << bench.device->fault_detail();
      ASSERT_TRUE(bench.sample.fresh);
    }
    EXPECT_GT(starting, 3) << "step by step";
    EXPECT_LT(starting, 50);
    EXPECT_NE(bench.drives.axis[0].permille, 0);
  }
}

TEST(Cia402Delta, TheLastWriteOfTheLoopLeavesNoHeartbeatFault) {
  Bench bench, killed;
  bench.run();
  killed.run();
  bench.permitted = false;
  bench.loop();
  for (Bench* one : {&bench, &killed})
    for (int i = 0; i < 200; ++i) one->drives.millisecond();  // stop() comes later
  for (const auto& axis : bench.drives.axis) EXPECT_EQ(axis.status, 0x40);
  for (const auto& axis : killed.drives.axis) EXPECT_EQ(axis.error_code, 0x8130);
}

TEST(Cia402Delta, DrivesThatWereNeverPermittedMonitorNoHeartbeat) {
  Bench bench;
  ASSERT_EQ(bench.open(), "");
  bench.permitted = false;
  for (int i = 0; i < 10; ++i) bench.tick();
  for (int i = 0; i < 200; ++i) bench.drives.millisecond();
  for (const auto& axis : bench.drives.axis) EXPECT_EQ(axis.status, 0x40);
}

TEST(Cia402Delta, EveryDriveWatchesTheHostBeforeItGetsPowerAgain) {
  Bench bench;
  bench.run();
  bench.permitted = false;
  for (int i = 0; i < 10; ++i) bench.tick();
  for (auto& axis : bench.drives.axis) EXPECT_EQ(axis.written[0x101601], 127u << 16);
  bench.permitted = true;
  bench.drives.axis[1].answers_watch = false;
  EXPECT_GT(bench.ticks_until(Fault::kDriveFault, 4000), 2900);
  EXPECT_EQ(bench.drives.axis[1].status, 0x40) << "no power to who would not let go by itself";
  EXPECT_TRUE(bench.says("arm 2 (node 2 on can0): the drive does not take up its watch"))
      << bench.device->fault_detail();
  Bench good;
  good.run();
  good.permitted = false;
  for (int i = 0; i < 10; ++i) good.tick();
  good.permitted = true;
  EXPECT_GT(good.ticks_until_ready(50), 0);
  for (auto& axis : good.drives.axis) EXPECT_EQ(axis.written[0x101601], 127u << 16 | 20u);
}

TEST(Cia402Delta, ADriveThatKeepsItsWatchRunsAsWell) {
  Bench bench;
  bench.run();
  for (auto& axis : bench.drives.axis) axis.refuses_watch = true, axis.abort_code = 0x08000022;
  bench.permitted = false;
  for (int i = 0; i < 300; ++i)
    ASSERT_EQ(bench.tick(), Fault::kNone) << bench.device->fault_detail();
  bench.permitted = true;
  EXPECT_GT(bench.ticks_until_ready(50), 0) << bench.device->fault_detail();
}

TEST(Cia402Delta, StopLetsGoForGoodAndLeavesNoFaultBehind) {
  Bench bench;
  bench.run();
  bench.tick({0.0, 0.0, 4.0});
  bench.device->stop();
  bench.drives.listen();
  for (auto& axis : bench.drives.axis) {
    EXPECT_EQ(axis.status, 0x40);
    EXPECT_EQ(axis.permille, 0);
    EXPECT_EQ(axis.nmt, NmtState::kPreOperational);
    EXPECT_EQ(axis.written[0x101601], 127u << 16) << "no heartbeat is monitored";
  }
  bench.drives.forget();
  bench.device->stop();
  for (int i = 0; i < 10; ++i) bench.tick({0.0, 0.0, 4.0});
  EXPECT_TRUE(bench.drives.heard.empty());
}

}  // namespace tact::hal::cia402::cia402_delta_test
