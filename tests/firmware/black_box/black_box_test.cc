// SPDX-License-Identifier: Apache-2.0
// The last seconds before a fault: what is kept, what reaches the disk, what a person then sees.
#include "firmware/black_box/black_box.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "firmware/protocol/tick_log.h"
#include "firmware/telemetry/frame_builder.h"
#include "host/record/recording.h"
#include "tests/support/damage.h"
#include "tests/support/message.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::black_box::black_box_test {

namespace fs = std::filesystem;

class BlackBoxTest : public testing::Test {
 protected:
  BlackBoxTest()
      : folder(testing::TempDir() + "tact-black-box-" + std::to_string(getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~BlackBoxTest() override { fs::remove_all(folder); }

  std::unique_ptr<BlackBox> make() const {
    const auto tissue = std::move(*model::scene::make_tissue(scene));
    auto header = telemetry::header_of(scene, *tissue);
    header.scene_name = "plate / 2";
    return std::move(
        *BlackBox::make({folder + "/kept", header, telemetry::mesh_bytes(scene)}, 1000.0, 50.0));
  }
  // Ticks as the telemetry thread gives them, a frame every 20.
  void ticks(BlackBox& box, int n, model::Fault fault = model::Fault::kNone) {
    for (int i = 0; i < n; ++i, ++tick) {
      loop::TickRecord record;
      record.tick = tick;
      record.due_ns = static_cast<std::int64_t>(tick) * 1'000'000;
      record.output.fault = fault;
      record.output.state =
          fault == model::Fault::kNone ? loop::State::kArmed : loop::State::kStopped;
      record.output.written.force_N.z =
          fault == model::Fault::kNone ? 0.001 * static_cast<double>(tick) : 0;
      box.add(protocol::LoggedTick::of(record, false));
      if (tick % 20 != 0) continue;
      protocol::Frame frame;
      frame.tick = tick;
      frame.time_ns = record.due_ns;
      frame.state = record.output.state;
      frame.fault = static_cast<std::uint16_t>(fault);
      box.add(frame);
      box.work();
    }
  }
  static std::vector<protocol::LoggedTick> logged(const std::string& path) {
    std::vector<protocol::LoggedTick> out;
    auto log = protocol::TickLog::open(path);
    EXPECT_TRUE(log);
    for (protocol::LoggedTick one; log && log->next(one);) out.push_back(one);
    return out;
  }

  model::scene::Scene scene = tests::make_plate_scene();
  std::string folder;
  std::uint64_t tick = 0;
};

TEST_F(BlackBoxTest, HoldsEveryTickOfTheLastTenSecondsAndAQuarterAfterTheFault) {
  const auto box = make();
  ticks(*box, 15'000);
  EXPECT_TRUE(box->files().empty()) << "no fault, no file";
  ticks(*box, 1000, model::Fault::kDeviceLost);
  box->finish();
  ASSERT_EQ(box->files().size(), 1u);
  const auto kept = logged(box->files()[0]);
  ASSERT_EQ(kept.size(), 10'000u);
  for (std::size_t i = 1; i < kept.size(); ++i) ASSERT_EQ(kept[i].tick, kept[i - 1].tick + 1);
  EXPECT_EQ(kept.front().output.written.force_N.z, 0.001 * static_cast<double>(kept.front().tick));
  EXPECT_GE(kept.back().tick, 15'250u) << "shows the force going";
  EXPECT_LE(kept.back().tick, 15'280u) << "and no more than that";
  EXPECT_NE(box->files()[0].find("plate---2-"), std::string::npos) << box->files()[0];
  EXPECT_NE(box->files()[0].find("-103-device-lost"), std::string::npos) << box->files()[0];
}

TEST_F(BlackBoxTest, SeveralFaultsOfARunGiveSeveralFilesAndNoneIsWrittenOver) {
  const auto box = make();
  for (int round = 0; round < 3; ++round) {
    ticks(*box, 500);
    ticks(*box, 400, model::Fault::kEmergencyStop);
    box->finish();  // within one second: the same name but for a number
  }
  ASSERT_EQ(box->files().size(), 3u);
  std::size_t before = 0;
  for (const std::string& path : box->files()) {
    const auto kept = logged(path);
    EXPECT_GT(kept.size(), before) << "each holds what came before, too";
    before = kept.size();
  }
  EXPECT_EQ(static_cast<int>(std::distance(fs::directory_iterator(folder + "/kept"), {})), 3);
}

TEST_F(BlackBoxTest, ALoopThatGivesNoMoreTicksIsNotWaitedFor) {
  const auto box = make();
  ticks(*box, 500);
  box->report_fault(model::Fault::kNone);
  box->work();
  EXPECT_TRUE(box->files().empty());
  box->report_fault(model::Fault::kLoopStalled);
  box->work();
  for (int i = 0; i < 5000 && box->files().empty(); ++i) usleep(1000);
  ASSERT_EQ(box->files().size(), 1u);
  EXPECT_EQ(logged(box->files()[0]).size(), 500u);
  ticks(*box, 500, model::Fault::kLoopStalled);  // it came back: the same fault is no second one
  box->finish();
  EXPECT_EQ(box->files().size(), 1u);
}

TEST_F(BlackBoxTest, TheViewerShowsItWithEveryTickOfTheLastHalfSecond) {
  const auto box = make();
  ticks(*box, 3000);
  ticks(*box, 300, model::Fault::kDeviceLost);
  box->finish();
  const host::record::ReadResult read = host::record::read_recording(box->files().at(0));
  ASSERT_TRUE(read.usable) << read.damage;
  EXPECT_EQ(read.damage, "");
  const auto& frames = read.recording.frames;
  EXPECT_EQ(read.recording.header.organ_vertices, scene.organ_mesh.vertex_m.size());
  std::size_t single = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    ASSERT_GT(frames[i].time_ns, frames[i - 1].time_ns);
    if (frames[i].tick == frames[i - 1].tick + 1) ++single;
  }
  EXPECT_GE(single, 499u);
  EXPECT_LE(single, 520u);
  EXPECT_EQ(frames.back().fault, 103);
  const auto at = std::find_if(frames.begin(), frames.end(),
                               [](const protocol::Frame& frame) { return frame.tick == 2999; });
  ASSERT_NE(at, frames.end());
  EXPECT_FLOAT_EQ(at->force_N[2], 2.999f) << "the tick's own force";
  EXPECT_EQ(at->fault, 0);
}

TEST_F(BlackBoxTest, AnOrdinaryTickLogIsRefusedByTheViewerWithAReason) {
  const std::string path = folder + "/run.tactlog";
  auto log = std::move(*protocol::RunWriter::create(
      path, protocol::start_of_run({}, {}, {protocol::schema_of<protocol::LoggedTick>()})));
  log.add(chunk_of(protocol::LoggedTick{}));
  ASSERT_EQ(tests::message_of(log.close()), "");
  const host::record::ReadResult read = host::record::read_recording(path);
  EXPECT_FALSE(read.usable);
  EXPECT_NE(read.damage.find("holds no frames"), std::string::npos) << read.damage;
}

TEST_F(BlackBoxTest, ACutOffFileKeepsItsTicksAndSaysThatThePicturesAreMissing) {
  const auto box = make();
  ticks(*box, 500);
  ticks(*box, 300, model::Fault::kDeviceLost);
  box->finish();
  const std::string path = box->files().at(0);
  const std::string start =
      start_of_run(protocol::TickLog::open(path)->header(), telemetry::mesh_bytes(scene),
                   {protocol::schema_of<protocol::LoggedTick>(protocol::LoggedTick::fields(1)),
                    protocol::schema_of<protocol::Frame>(protocol::Frame::fields(1))});
  const std::size_t size = chunk_of(protocol::LoggedTick{}, protocol::LoggedTick::fields(1)).size();
  fs::resize_file(path, start.size() + 300 * size + 7);
  EXPECT_EQ(logged(path).size(), 300u);
  EXPECT_NE(host::record::read_recording(path).damage.find("cut off"), std::string::npos);
}

TEST_F(BlackBoxTest, EveryDamageIsReportedByItsTicksAndByItsPictures) {
  const auto box = make();
  ticks(*box, 100);
  ticks(*box, 300, model::Fault::kDeviceLost);
  box->finish();
  tests::expect_all_damage_is_reported(box->files().at(0), [](const std::string& path) {
    auto log = protocol::TickLog::open(path);
    for (protocol::LoggedTick one; log && log->next(one);) continue;
    const bool reported = !log || log->damage().find("good ticks were read") != std::string::npos;
    const host::record::ReadResult read = host::record::read_recording(path);
    return reported && !read.damage.empty();
  });
}

TEST_F(BlackBoxTest, AFullDiskIsReportedAndCostsNothingElse) {
  const auto box = make();
  ticks(*box, 2000);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{.rlim_cur = 100'000, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);  // as of a disk with so much room
  ticks(*box, 300, model::Fault::kDeviceLost);
  box->finish();
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(box->files().empty());
  auto news = box->news();
  ASSERT_EQ(news.size(), 1u);
  EXPECT_NE(news[0].find("File too large"), std::string::npos) << news[0];
  EXPECT_TRUE(box->news().empty()) << "reported once";
  ticks(*box, 100);
  ticks(*box, 300, model::Fault::kEmergencyStop);
  box->finish();
  EXPECT_EQ(box->files().size(), 1u) << "the next fault is tried again";
}

TEST_F(BlackBoxTest, AFullFolderKeepsItsNewestAndNoFileOfOthersIsRemoved) {
  const auto now = fs::file_time_type::clock::now();
  const auto put = [&](const std::string& name, int hours_ago) {
    std::ofstream(folder + "/" + name) << std::string(1000, '.');
    fs::last_write_time(folder + "/" + name, now - std::chrono::hours(hours_ago));
  };
  for (int i = 1; i <= 9; ++i)
    put("liver-2026010" + std::to_string(i) + "T000000Z-105-loop-late.tactbox", 10 - i);
  for (const char* other : {"notes.txt", "run.tactlog", "run-1.tactlog"}) put(other, 100);
  EXPECT_EQ(remove_oldest(folder, 9000), 0u);
  EXPECT_EQ(remove_oldest(folder, 4500), 5u);
  EXPECT_FALSE(fs::exists(folder + "/liver-20260105T000000Z-105-loop-late.tactbox"));
  EXPECT_TRUE(fs::exists(folder + "/liver-20260106T000000Z-105-loop-late.tactbox"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 7) << "others stay";
  EXPECT_EQ(remove_oldest(folder + "/none", 0), 0u);
}

TEST_F(BlackBoxTest, ALongRecordKeepsItsNewestAndSaysWhatItDropped) {
  const std::string path = folder + "/run.tactlog";
  const std::string start =
      protocol::start_of_run({}, {}, {protocol::schema_of<protocol::LoggedTick>()});
  protocol::LoggedTick one;
  const std::size_t size = chunk_of(one).size();
  auto log = std::move(*protocol::RunWriter::create(path, start, 10 * size));
  int times = 0;
  for (one.tick = 0; one.tick < 35; ++one.tick) {
    log.add(chunk_of(one));
    if (const auto news = log.news()) {
      ++times;
      EXPECT_NE(news->find("run.tactlog.old keeps them, what came before is dropped"),
                std::string::npos);
    }
  }
  ASSERT_EQ(tests::message_of(log.close()), "");
  EXPECT_EQ(times, 3);
  EXPECT_EQ(logged(path + ".old").front().tick, 20u);
  EXPECT_EQ(logged(path).front().tick, 30u);
  EXPECT_EQ(logged(path).back().tick, 34u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 2);
}

TEST_F(BlackBoxTest, AFolderThatCannotBeWrittenIsRefusedWithItsRemedy) {
  std::ofstream(folder + "/file") << "no folder";
  const auto refused = black_box_folder(folder + "/file");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--black-box"), std::string::npos);
  const auto made = black_box_folder(folder + "/new/one");
  ASSERT_TRUE(made);
  EXPECT_FALSE(fs::exists(*made)) << "a run without faults leaves nothing behind";
  ASSERT_EQ(setenv("XDG_STATE_HOME", folder.c_str(), 1), 0);
  EXPECT_EQ(*black_box_folder(""), folder + "/tact/black-box");
  unsetenv("XDG_STATE_HOME");
}

}  // namespace tact::firmware::black_box::black_box_test
