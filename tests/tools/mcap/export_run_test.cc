// SPDX-License-Identifier: Apache-2.0
// Logs and recordings that are whole, cut off, damaged, or none.
#include "tools/mcap/export_run.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "firmware/telemetry/tick_log.h"
#include "host/record/recording.h"
#include "tests/support/damage.h"
#include "tests/support/program.h"
#include "tests/support/sentence.h"
#include "tests/support/telemetry_source.h"

namespace tact::tools::mcap::export_run_test {

namespace fs = std::filesystem;
using firmware::telemetry::LoggedTick;
using firmware::telemetry::LogHeader;
using firmware::telemetry::LogRecord;
using firmware::telemetry::TickLogWriter;
using tests::sentence_of;

constexpr std::int64_t kPeriod_ns = 1'000'000, kStart_ns = 77'000'000'000;
constexpr std::uint64_t kTicks = 40, kFirst = 100;

class ExportRun : public testing::Test {
 protected:
  ExportRun() : folder_(testing::TempDir() + "tact-mcap-" + std::to_string(getpid())) {
    fs::create_directories(folder_);
  }
  ~ExportRun() override { fs::remove_all(folder_); }

  static firmware::telemetry::Frame frame_of(std::uint64_t tick) {
    auto frame = test::make_frame(1.0f, firmware::telemetry::SiteState::kTouching);
    frame.tick = tick;
    frame.time_ns = static_cast<std::int64_t>(tick) * kPeriod_ns;
    return frame;
  }
  /// A log, or with its recording a black box.
  std::string write_log(bool black_box) const {
    const std::string path = folder_ + (black_box ? "/box.tactlog" : "/run.tactlog");
    LogHeader header;
    header.ticks = black_box ? kTicks : 0;
    header.period_ns = kPeriod_ns;
    std::strcpy(header.began_utc, "1970-01-01T00:01:40Z");
    auto log = TickLogWriter::create(path, header);
    EXPECT_EQ(sentence_of(log), "");
    for (std::uint64_t i = kFirst; i < kFirst + kTicks; ++i) {
      LoggedTick tick;
      tick.tick = i;
      tick.due_ns = kStart_ns + static_cast<std::int64_t>(i) * kPeriod_ns;
      log->add(tick);
    }
    if (black_box) {
      log->append(
          host::record::recording_start(test::make_hello(3, 1, 3, 1), test::TinyMeshes{}.bytes()));
      for (std::uint64_t i = kFirst; i < kFirst + kTicks; i += 10)
        log->append(host::record::recording_frame(frame_of(i)));
    }
    EXPECT_EQ(sentence_of(log->close()), "");
    return path;
  }
  std::string write_recording() const {
    const std::string path = folder_ + "/run.tactrec";
    host::record::RecordingWriter writer;
    EXPECT_EQ(
        sentence_of(writer.open(path, test::make_hello(3, 1, 3, 1), test::TinyMeshes{}.bytes())),
        "");
    for (std::uint64_t i = 0; i < kTicks; ++i)
      EXPECT_EQ(sentence_of(writer.write(frame_of(i))), "");
    EXPECT_EQ(sentence_of(writer.close()), "");
    return path;
  }
  static std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// It ends well and says the damage, or there is no file and a sentence with the name.
  bool tells(const std::string& path) const {
    fs::remove(out_);
    const auto done = export_run(path, out_);
    if (!done) return !fs::exists(out_) && sentence_of(done).find(path) == 0;
    const std::string bytes = bytes_of(out_);
    return !done->damage.empty() && done->ticks + done->frames > 0 &&
           done->messages == 4 * (done->ticks + done->frames) &&
           bytes.substr(bytes.size() - 8) == "\x89MCAP0\r\n";
  }

  const std::string folder_, out_ = folder_ + "/out.mcap";
};

TEST_F(ExportRun, EveryKindIsExportedWhole) {
  for (const auto& [path, ticks, frames] :
       {std::tuple{write_log(false), kTicks, std::uint64_t{0}},
        std::tuple{write_log(true), kTicks, kTicks / 10},
        std::tuple{write_recording(), std::uint64_t{0}, kTicks}}) {
    const auto done = export_run(path, out_);
    ASSERT_EQ(sentence_of(done), "");
    EXPECT_EQ(done->damage, "");
    EXPECT_EQ(done->ticks, ticks);
    EXPECT_EQ(done->frames, frames);
    EXPECT_EQ(done->messages, 4 * (ticks + frames));
    EXPECT_NEAR(done->length_s, 0.039, 1e-12);
  }
}

TEST_F(ExportRun, TimeIsTheDateOfTheStartAndWhatHasPassedSince) {
  ASSERT_EQ(sentence_of(export_run(write_log(false), out_)), "");
  // 1970-01-01 00:01:40 and 100 ticks of 1 ms: the first log_time and publish_time.
  const std::uint64_t first_ns = 100'000'000'000 + 100 * 1'000'000;
  const std::string time(reinterpret_cast<const char*>(&first_ns), sizeof first_ns);
  EXPECT_NE(bytes_of(out_).find(time + time), std::string::npos);
}

TEST_F(ExportRun, AllDamageIsToldAndWhatIsWholeIsExported) {
  for (const std::string& path : {write_log(false), write_log(true), write_recording()})
    tests::expect_all_damage_is_told(path, [this](const std::string& p) { return tells(p); });
}

TEST_F(ExportRun, ALogWithoutAGoodTickIsRefused) {
  const std::string path = write_log(false);
  fs::resize_file(path, sizeof(LogHeader) + sizeof(LogRecord) - 1);
  EXPECT_NE(sentence_of(export_run(path, out_)).find("holds no whole tick"), std::string::npos);
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(ExportRun, WhatIsNoRunOfTactIsRefused) {
  const std::string other = folder_ + "/other";
  std::ofstream(other) << "tactlog6 of an earlier version";
  EXPECT_NE(sentence_of(export_run(other, out_)).find("version 6"), std::string::npos);
  std::ofstream(other) << "hello";
  EXPECT_NE(sentence_of(export_run(other, out_)).find("is not a tact recording"),
            std::string::npos);
  std::ofstream(other, std::ios::trunc).close();
  for (const std::string& path : {other, folder_, folder_ + "/none"})
    EXPECT_EQ(sentence_of(export_run(path, out_)).find(path), 0u);
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(ExportRun, AnInputIsNeverWrittenOver) {
  const std::string path = write_log(false), before = bytes_of(path);
  EXPECT_NE(sentence_of(export_run(path, path)), "");
  EXPECT_EQ(bytes_of(path), before);
}

TEST_F(ExportRun, TheProgramSaysWhatItDidByItsExitStatus) {
  const std::string path = write_log(false);
  const tests::Outcome good = tests::run_program("tact-mcap", path + " " + out_);
  EXPECT_EQ(good.status, 0) << good.output;
  EXPECT_EQ(good.output, out_ + ": 40 ticks, 0 frames, 0.0 s\n");
  fs::resize_file(path, sizeof(LogHeader) + 7 * sizeof(LogRecord) + 3);
  const tests::Outcome cut = tests::run_program("tact-mcap", path + " " + out_);
  EXPECT_EQ(cut.status, 1) << cut.output;
  EXPECT_NE(cut.output.find("cut off in tick number 8"), std::string::npos) << cut.output;
  EXPECT_EQ(tests::run_program("tact-mcap", folder_ + " " + out_).status, 2);
  EXPECT_EQ(tests::run_program("tact-mcap", path).status, 2);
}

}  // namespace tact::tools::mcap::export_run_test
