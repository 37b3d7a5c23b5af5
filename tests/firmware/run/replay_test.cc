// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/replay.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "firmware/loop/rt_loop.h"
#include "firmware/pc/rt_setup.h"
#include "hal/registry/open_device.h"
#include "tests/support/sentence.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::run::replay_test {

class ReplayTest : public testing::Test {
 protected:
  void SetUp() override {
    pc::flush_denormals();
    record(3000);
  }
  void TearDown() override { std::remove(path.c_str()); }

  // A run with everything in it that decides forces: late ticks and arming.
  void record(int ticks) {
    auto device = std::move(*hal::registry::open_device(scene));
    auto ring = std::make_unique<loop::TickRing>();
    loop::Controller controller(tissue->contact_scene(), gate::Gate(scene.limits, 0.001, 0.25),
                                /*hard_real_time=*/false);
    loop::SimulatedClock clock;
    loop::Requests requests;
    hal::NoSafetyLines lines;
    requests.arm_at_start.store(true);
    loop::RtLoop loop({.period_ns = 1'000'000}, *device, lines, controller, clock, requests, *ring);
    telemetry::LogHeader header;
    header.period_ns = 1'000'000;
    header.limits = scene.limits;
    header.force_share = 0.25;
    header.non_rt = 1;
    scene.hash.copy(header.scene_hash, sizeof header.scene_hash - 1);
    auto log = std::move(*telemetry::TickLogWriter::create(path, header));
    loop::TickRecord record;
    for (int i = 0; i < ticks; ++i) {
      if (i == 1300) clock.pass_ns(30'300'000);  // a fault, were this hard real time
      if (i == 1500) clock.pass_ns(5'300'000);
      loop.step();
      while (ring->pop(record)) log.add(record);
    }
    EXPECT_EQ(tests::sentence_of(log.close()), "");
  }

  // Change one byte of the log.
  void corrupt(long offset) const {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(offset);
    const int byte = file.get();
    file.seekp(offset);
    file.put(static_cast<char>(byte ^ 0x10));
  }

  model::scene::Scene scene = tests::make_plate_scene();
  std::unique_ptr<model::scene::Tissue> tissue = std::move(*model::scene::make_tissue(scene));
  std::string path = "/tmp/tact-replay-test-" + std::to_string(getpid());
};

TEST_F(ReplayTest, TheSameSamplesGiveTheSameForcesBitForBit) {
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_TRUE(outcome) << outcome.error().sentence;
  EXPECT_EQ(outcome->ticks, 3000u);
  EXPECT_EQ(outcome->different, 0u);
  EXPECT_FALSE(outcome->truncated);
}

TEST_F(ReplayTest, AnotherSampleGivesAnotherForceAndIsNamed) {
  // Twelve bits into the mantissa of one position, in contact.
  const long at = static_cast<long>(
      sizeof(telemetry::LogHeader) + 1800 * sizeof(telemetry::LoggedTick) +
      offsetof(telemetry::LoggedTick, input) + offsetof(loop::TickInput, sample) + 16 + 5);
  corrupt(at);
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_TRUE(outcome);
  EXPECT_GT(outcome->different, 0u);
  EXPECT_EQ(outcome->first_different, 1800u);
}

TEST_F(ReplayTest, AnotherSceneIsRefused) {
  scene.hash = "fedcba9876543210";
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().sentence.find("another scene"), std::string::npos);
}

TEST_F(ReplayTest, ATornLogIsReplayedUpToItsTear) {
  ASSERT_EQ(truncate(path.c_str(), static_cast<long>(sizeof(telemetry::LogHeader) +
                                                     100 * sizeof(telemetry::LoggedTick) + 17)),
            0);
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->ticks, 100u);
  EXPECT_TRUE(outcome->truncated);
}

TEST_F(ReplayTest, WhatIsNoLogIsRefused) {
  std::ofstream(path) << "hello, this is no log at all, but it is long enough for a header, surely";
  EXPECT_FALSE(replay(path, scene, *tissue));
  EXPECT_FALSE(replay("/nowhere/at/all", scene, *tissue));
}

TEST_F(ReplayTest, ALogOfAnotherVersionIsRefusedByItsNumber) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(7);
  file.put('2');
  file.close();
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().sentence.find("version 2, this tactd reads version 6"),
            std::string::npos)
      << outcome.error().sentence;
}

TEST_F(ReplayTest, EveryRecordOfAPCWithoutHardRealTimeIsStamped) {
  auto log = std::move(*telemetry::TickLogReader::open(path));
  telemetry::LoggedTick tick;
  int stamped = 0;
  while (log.next(tick)) stamped += tick.non_rt;
  EXPECT_EQ(stamped, 3000);
}

TEST_F(ReplayTest, ALogIsNeverOverwritten) {
  EXPECT_FALSE(telemetry::TickLogWriter::create(path, {}));
}

}  // namespace tact::firmware::run::replay_test
