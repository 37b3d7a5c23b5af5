// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/replay.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "firmware/loop/rt_loop.h"
#include "firmware/pc/rt_setup.h"
#include "firmware/telemetry/tick_csv.h"
#include "hal/registry/open_device.h"
#include "tests/support/damage.h"
#include "tests/support/message.h"
#include "tests/support/pass_time.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::run::replay_test {

struct ClutchLine final : hal::SafetyLines {
  model::Fault read(std::int64_t) RT_SAFE override { return model::Fault::kNone; }
  model::Fault write(const hal::LinesTick&) RT_SAFE override { return model::Fault::kNone; }
  bool enabled() const RT_SAFE override { return true; }
  std::optional<bool> clutch() const RT_SAFE override { return pressed; }
  void scope(bool) RT_SAFE override {}
  void stop() override {}
  bool pressed = false;
};

std::string start_of_log(const protocol::RunHeader& header) {
  return start_of_run(header, {}, {protocol::schema_of<protocol::LoggedTick>()});
}

class ReplayTest : public testing::Test {
 protected:
  /// Where the chunk of a tick begins, of a log whose ticks are all good.
  std::uint64_t byte_of_tick(std::uint64_t tick) const {
    return start_of_log(protocol::TickLog::open(path)->header()).size() +
           tick * chunk_of(protocol::LoggedTick{}).size();
  }

  void SetUp() override {
    pc::flush_denormals();
    record(3000);
  }
  void TearDown() override { std::remove(path.c_str()); }

  // A run with everything in it that decides forces: late ticks, arming, a clutch.
  void record(int ticks) {
    auto device = std::move(*hal::registry::open_device(scene));
    auto ring = std::make_unique<loop::TickRing>();
    loop::Controller controller(tissue->contact_scene(), gate::Gate(scene.limits, 0.001, 0.25),
                                /*hard_real_time=*/false);
    loop::SimulatedClock clock;
    loop::Requests requests;
    ClutchLine lines;
    requests.arm_at_start.store(true);
    loop::RtLoop loop({.period_ns = 1'000'000}, *device, lines, controller, clock, requests, *ring);
    protocol::RunHeader header;
    header.rate_Hz = 1000.0;
    header.limits = scene.limits;
    header.force_share = 0.25;
    header.non_rt = true;
    header.scene_hash = scene.hash;
    auto log = std::move(*protocol::RunWriter::create(path, start_of_log(header)));
    loop::TickRecord record;
    for (int i = 0; i < ticks; ++i) {
      if (i == 1300) tests::pass_ns(clock, 30'300'000);  // a fault, were this hard real time
      if (i == 1500) tests::pass_ns(clock, 5'300'000);
      lines.pressed = i >= 2000 && i < 2200;
      loop.step();
      while (ring->pop(record)) log.add(chunk_of(protocol::LoggedTick::of(record, true)));
    }
    EXPECT_EQ(tests::message_of(log.close()), "");
  }

  model::scene::Scene scene = tests::make_plate_scene();
  std::unique_ptr<model::scene::Tissue> tissue = std::move(*model::scene::make_tissue(scene));
  std::string path = "/tmp/tact-replay-test-" + std::to_string(getpid());
};

TEST_F(ReplayTest, TheSameSamplesGiveTheSameForcesBitForBit) {
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->ticks, 3000u);
  EXPECT_EQ(outcome->different, 0u);
  EXPECT_EQ(outcome->damage, "");
  auto log = std::move(*protocol::TickLog::open(path));
  int open_ticks = 0;
  for (protocol::LoggedTick tick; log.next(tick);)
    open_ticks += tick.input.clutch == loop::ClutchState::kOpen ? 1 : 0;
  EXPECT_GT(open_ticks, 50);
}

TEST_F(ReplayTest, AnotherSampleGivesAnotherForceAndIsNamed) {
  auto log = std::move(*protocol::TickLog::open(path));
  const std::string other = path + ".other";
  {
    auto writer = std::move(*protocol::RunWriter::create(other, start_of_log(log.header())));
    for (protocol::LoggedTick tick; log.next(tick);) {
      if (tick.tick == 1800) tick.input.sample.tool.position_m.z += 2e-4;  // in contact
      writer.add(chunk_of(tick));
    }
    EXPECT_EQ(tests::message_of(writer.close()), "");
  }
  const auto outcome = replay(other, scene, *tissue);
  std::remove(other.c_str());
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->damage, "");
  EXPECT_GT(outcome->different, 0u);
  EXPECT_GE(outcome->first_different, 1800u);
  EXPECT_LE(outcome->first_different, 1801u) << "the gate hides one tick at most";
}

TEST_F(ReplayTest, EveryDamageIsReportedWithHowMuchIsGood) {
  std::remove(path.c_str());
  record(200);
  tests::expect_all_damage_is_reported(path, [&](const std::string& damaged) {
    const auto outcome = replay(damaged, scene, *tissue);
    if (!outcome) return !outcome.error().message.empty();
    return outcome->damage.find(" good ticks were read") != std::string::npos;
  });
}

TEST_F(ReplayTest, ADamagedTickCostsItselfAndIsNeverCompared) {
  const auto at = static_cast<std::streamoff>(byte_of_tick(1800) + 100);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(at);
  const int byte = file.get();
  file.seekp(at);
  file.put(static_cast<char>(byte ^ 0x10));
  file.close();
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->ticks, 1800u);
  EXPECT_EQ(outcome->different, 0u);
  EXPECT_EQ(outcome->gap_before, 1801u);
  EXPECT_EQ(outcome->damage.find("1 of 3000 ticks are damaged, the first at byte "), 0u)
      << outcome->damage;
  EXPECT_NE(outcome->damage.find("; 2999 good ticks were read"), std::string::npos);
}

TEST_F(ReplayTest, TheTableHasEveryTickAndSaysWhichRunItWas) {
  const std::string csv = path + ".csv";
  const auto damage = telemetry::write_tick_csv(path, csv);
  ASSERT_TRUE(damage) << damage.error().message;
  EXPECT_EQ(*damage, "");
  std::ifstream file(csv);
  std::string line, names, row;
  int comments = 0, rows = 0;
  while (std::getline(file, line))
    if (line[0] == '#')
      ++comments;
    else if (names.empty())
      names = line;
    else if (rows++ == 1800)
      row = line;
  std::remove(csv.c_str());
  EXPECT_EQ(comments, 13);
  EXPECT_EQ(rows, 3000);
  for (const char* name : {"tick,non_rt,due_ns,", ",tool_position_x_m,", ",wanted_force_x_N,",
                           ",force_x_N,", ",limit,limit_name,", ",rms_force_N,contact_losses,",
                           ",phase_limit_ns,", ",utc_offset_ns,", ",event_word,"})
    EXPECT_NE(names.find(name), std::string::npos) << name;
  EXPECT_EQ(std::count(names.begin(), names.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_EQ(row.find("1800,"), 0u) << row;
}

TEST_F(ReplayTest, AnotherSceneIsRefused) {
  scene.hash = "fedcba9876543210";
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("another scene"), std::string::npos);
}

TEST_F(ReplayTest, ATornLogIsReplayedUpToItsTear) {
  ASSERT_EQ(truncate(path.c_str(), static_cast<long>(byte_of_tick(100) + 17)), 0);
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->ticks, 100u);
  EXPECT_EQ(outcome->damage.find("the file is cut off at byte "), 0u);
}

TEST_F(ReplayTest, ForeignOrMissingFileIsRefused) {
  std::ofstream(path) << "hello, this is no log at all, but it is long enough for a header, surely";
  EXPECT_FALSE(replay(path, scene, *tissue));
  EXPECT_FALSE(replay("/nowhere/at/all", scene, *tissue));
}

TEST_F(ReplayTest, ALogOfAnEarlierFormatIsRefusedWithTheRemedy) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file << "tactlogA";
  file.close();
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("record it again"), std::string::npos)
      << outcome.error().message;
}

TEST_F(ReplayTest, ATickWithoutAFieldOfThisProgramIsNotReplayed) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const std::string start = start_of_log(protocol::TickLog::open(path)->header());
  const std::string head = start.substr(protocol::kMagic.size() + sizeof(protocol::ChunkHeader));
  auto json = nlohmann::json::parse(head);
  for (auto& field : json["records"]["tick"]["fields"])
    if (field["name"] == "sample_fresh") field["name"] = "renamed";
  bytes.replace(0, start.size(),
                std::string(protocol::kMagic) + chunk_of(protocol::ChunkKind::kHead, json.dump()));
  std::ofstream(path, std::ios::binary) << bytes;
  const auto outcome = replay(path, scene, *tissue);
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("its ticks have no sample_fresh"), std::string::npos)
      << outcome.error().message;
}

TEST_F(ReplayTest, ALogThatBeginsInTheMiddleIsNotReplayed) {
  auto log = std::move(*protocol::TickLog::open(path));
  const std::string other = path + ".other";
  auto writer = std::move(*protocol::RunWriter::create(other, start_of_log(log.header())));
  for (protocol::LoggedTick tick; log.next(tick);)
    if (tick.tick >= 7) writer.add(chunk_of(tick));
  EXPECT_EQ(tests::message_of(writer.close()), "");
  const auto outcome = replay(other, scene, *tissue);
  std::remove(other.c_str());
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("begins at tick 7, in the middle of a run"),
            std::string::npos)
      << outcome.error().message;
}

TEST_F(ReplayTest, EveryRecordOfAPCWithoutHardRealTimeIsStamped) {
  auto log = std::move(*protocol::TickLog::open(path));
  protocol::LoggedTick tick;
  int stamped = 0;
  while (log.next(tick)) stamped += tick.non_rt ? 1 : 0;
  EXPECT_EQ(stamped, 3000);
}

TEST_F(ReplayTest, ALogIsNeverOverwritten) { EXPECT_FALSE(protocol::RunWriter::create(path, "")); }

}  // namespace tact::firmware::run::replay_test
