// SPDX-License-Identifier: Apache-2.0
#include "host/record/recording.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>

#include "host/record/operator_record.h"
#include "host/record/recording_csv.h"
#include "host/record/telemetry_check.h"
#include "tests/host/record/spoilt_file.h"
#include "tests/support/damage.h"
#include "tests/support/message.h"
#include "tests/support/telemetry_source.h"

namespace tact::host::record::recording_test {

using tests::message_of;

constexpr std::size_t kFrames = 50;
const firmware::protocol::FieldTable kFields = Frame::fields(2);  // the spheres of make_header
const std::size_t kFrameBytes = chunk_of(Frame{}, kFields).size();

class RecordingFile : public ::testing::Test {
 protected:
  RecordingFile()
      : path_(std::filesystem::temp_directory_path() /
              ("tact-recording-" + std::to_string(getpid()) + ".tact")) {
    std::filesystem::remove(path_);
    RecordingWriter writer;
    EXPECT_EQ(message_of(writer.open(path_, header_, mesh_)), "");
    for (std::size_t i = 0; i < kFrames; ++i) EXPECT_EQ(message_of(writer.write(frame(i))), "");
    EXPECT_EQ(message_of(writer.close()), "");
  }
  ~RecordingFile() override { std::filesystem::remove(path_); }

  static Frame frame(std::size_t i) {
    Frame frame = test::make_frame(static_cast<float>(i), model::ContactState::kInContact);
    frame.tick = i;
    frame.time_ns = static_cast<std::int64_t>(i) * 10'000'000;
    return frame;
  }
  std::uint64_t first_frame_byte() const { return start_of_recording(header_, mesh_).size(); }

  std::string path_;
  RunHeader header_ = test::make_header(3, 1, 3, 1);
  MeshBytes mesh_ = test::TinyMeshes{}.bytes();
};

TEST(Meshes, MayEndWithColoursOfAllVerticesOfTheOrganAndNotOfSome) {
  const RunHeader header = test::make_header(3, 1, 3, 1);
  MeshBytes mesh = test::TinyMeshes{}.bytes();
  EXPECT_EQ(check_mesh(header, mesh), std::nullopt);
  mesh.resize(mesh.size() + 9, std::byte{0xFF});
  EXPECT_EQ(check_mesh(header, mesh), std::nullopt);
  mesh.pop_back();
  EXPECT_TRUE(check_mesh(header, mesh));
}

TEST_F(RecordingFile, ComesBackAsItWasWritten) {
  const ReadResult read = read_recording(path_);
  EXPECT_EQ(read.damage, "");
  ASSERT_TRUE(read.usable);
  ASSERT_EQ(read.recording.frames.size(), kFrames);
  EXPECT_EQ(read.recording.mesh, mesh_);
  EXPECT_NEAR(read.recording.length_s(), 0.49, 1e-12);
  for (std::size_t i = 0; i < kFrames; ++i)
    EXPECT_EQ(chunk_of(read.recording.frames[i], kFields), chunk_of(frame(i), kFields));
}

TEST_F(RecordingFile, KeepsEveryWholeFrameOfATruncatedFile) {
  const std::uint64_t whole = 20;
  std::filesystem::resize_file(path_, first_frame_byte() + whole * kFrameBytes + 100);
  const ReadResult read = read_recording(path_);
  ASSERT_TRUE(read.usable);
  EXPECT_EQ(read.recording.frames.size(), whole);
  EXPECT_NE(read.damage.find("cut off"), std::string::npos) << read.damage;
  EXPECT_NE(read.damage.find("20 good frames"), std::string::npos) << read.damage;
}

TEST_F(RecordingFile, LosesOnlyTheFrameThatIsDamaged) {
  tests::flip_byte(path_, first_frame_byte() + 7 * kFrameBytes + 300);
  const ReadResult read = read_recording(path_);
  ASSERT_TRUE(read.usable);
  ASSERT_EQ(read.recording.frames.size(), kFrames - 1);
  EXPECT_EQ(read.recording.frames[6].tick, 6u);
  EXPECT_EQ(read.recording.frames[7].tick, 8u);
  EXPECT_NE(read.damage.find("1 of 50 frames"), std::string::npos) << read.damage;
}

TEST_F(RecordingFile, IsRefusedWhenHeadOrMeshesAreDamaged) {
  tests::flip_byte(path_, first_frame_byte() - 3);
  EXPECT_FALSE(read_recording(path_).usable);
  EXPECT_NE(read_recording(path_).damage.find("its meshes are damaged"), std::string::npos);
  tests::flip_byte(path_, 100);
  EXPECT_FALSE(read_recording(path_).usable);
  EXPECT_NE(read_recording(path_).damage.find("its head is damaged"), std::string::npos);
}

TEST_F(RecordingFile, EarlierFormatIsRefusedWithTheRemedy) {
  std::fstream(path_, std::ios::in | std::ios::out | std::ios::binary) << "tactrec\n";
  const ReadResult read = read_recording(path_);
  EXPECT_FALSE(read.usable);
  EXPECT_NE(read.damage.find("record it again"), std::string::npos) << read.damage;
}

TEST_F(RecordingFile, EveryDamageIsReported) {
  tests::expect_all_damage_is_reported(
      path_, [](const std::string& path) { return !read_recording(path).damage.empty(); });
}

TEST_F(RecordingFile, SurvivesEveryLength) {
  for (std::uint64_t size = first_frame_byte() + 900; size > 0; size = size * 9 / 10) {
    std::filesystem::resize_file(path_, size);
    const ReadResult read = read_recording(path_);
    EXPECT_FALSE(read.damage.empty()) << size;
    EXPECT_LE(read.recording.frames.size(), 1u);
  }
}

TEST_F(RecordingFile, IsNeverOverwritten) {
  RecordingWriter writer;
  EXPECT_NE(message_of(writer.open(path_, header_, mesh_)).find("never overwritten"),
            std::string::npos);
  EXPECT_EQ(message_of(writer.write(frame(0))), "");  // and does nothing
  EXPECT_EQ(read_recording(path_).recording.frames.size(), kFrames);
}

TEST(Recording, MissingOrForeignFileIsRefusedWithTheReason) {
  EXPECT_NE(read_recording("/nonexistent/x.tact").damage.find("no such file"), std::string::npos);
  EXPECT_NE(read_recording(std::string(TACT_SOURCE_DIR) + "/CMakeLists.txt")
                .damage.find("is no file of tact"),
            std::string::npos);
}

TEST_F(RecordingFile, KeepsWhatItHasWhenTheDiskIsFull) {
  std::filesystem::remove(path_);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{.rlim_cur = first_frame_byte() + 10 * kFrameBytes,
                     .rlim_max = before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  RecordingWriter writer;
  std::optional<model::Error> error = writer.open(path_, header_, mesh_);
  for (std::size_t i = 0; i < 1000 && !error; ++i) error = writer.write(frame(i));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message_of(error).find("what was written before is kept"), std::string::npos)
      << message_of(error);
  EXPECT_EQ(read_recording(path_).recording.frames.size(), 10u);
}

TEST(RecentFrames, KeepsFiveMinutesAndNoMore) {
  RecentFrames recent;
  recent.restart(2.0);  // 600 frames in 300 s
  Frame frame;
  for (frame.tick = 0; frame.tick < 1000; ++frame.tick) recent.add(frame);
  ASSERT_EQ(recent.frames().size(), 600u);
  EXPECT_EQ(recent.frames().front()->frame.tick, 400u);
  EXPECT_EQ(recent.frames().back()->frame.tick, 999u);
  recent.restart(2.0);
  EXPECT_TRUE(recent.frames().empty());
}

std::ptrdiff_t columns(const std::string& line) {
  return std::count(line.begin(), line.end(), ',') + 1;
}

TEST(RecordingCsv, SaysWhichRunItWasAndWhatARowIs) {
  RunHeader header = test::make_header(3, 1, 3, 1);
  header.scene_name = "two\nlines";
  const std::string facts = csv_facts(header);
  EXPECT_TRUE(facts.starts_with(
      "# tact frames\n# scene: two lines\n# scene_hash: \n# law: rhombus chain, N = 10\n"))
      << facts;
  EXPECT_NE(facts.find("\n# rate_Hz: 4000\n# frame_rate_Hz: 60\n# row: "), std::string::npos);
  std::istringstream lines(facts);
  for (std::string line; std::getline(lines, line);) EXPECT_EQ(line.substr(0, 2), "# ");
}

TEST(RecordingCsv, HasOneNameForEveryColumn) {
  const RunHeader header = test::make_header(3, 1, 3, 1);
  std::string row;
  append_csv_row(row, test::make_frame(1.0f, model::ContactState::kHeld), header);
  EXPECT_EQ(columns(row), columns(csv_header(header)));
  EXPECT_EQ(columns(row), 47 + 2 * (12 + 11 + 3));
  EXPECT_EQ(std::count(row.begin(), row.end(), '\n'), 1);
}

TEST(RecordingCsv, ReportsASphereInsideAndLossesOfContact) {
  Frame frame = test::make_frame(0.5f, model::ContactState::kInside);
  frame.contact_losses = 21;
  std::string row;
  append_csv_row(row, frame, test::make_header(3, 1, 3, 1));
  EXPECT_NE(row.find(",inside,"), std::string::npos) << row;
  EXPECT_NE(row.find(",0,21,"), std::string::npos) << row;
  EXPECT_NE(csv_header({}).find(",non_rt,contact_losses,temperature_C,cut_triangles,"),
            std::string::npos);
}

TEST(RecordingCsv, ReportsCutsAndTheLargestDisplacementOfAPatch) {
  Frame frame;
  frame.patch.cut_total = 40;
  frame.patch.vertex_count = 2;
  frame.patch.displacement_um[0][2] = -1500;
  frame.patch.displacement_um[1][0] = 3000;
  frame.patch.displacement_um[1][1] = -4000;
  frame.patch.displacement_um[2][0] = 32767;  // not in use
  std::string row;
  append_csv_row(row, frame, RunHeader{});
  EXPECT_NE(row.find(",40,2,0.005000\n"), std::string::npos) << row;
  EXPECT_NE(csv_header({}).find(",cut_triangles,patch_vertices,patch_most_m\n"), std::string::npos);
}

TEST(RecordingCsv, ReadsBackToTheSameFloat) {
  Frame frame;
  frame.force_N[0] = 0.1f + 0.2f;
  std::string row;
  append_csv_row(row, frame, RunHeader{});
  std::string cell = row;
  const std::string names = csv_header({});
  for (auto i = columns(names.substr(0, names.find(",force_x_N"))); i > 0; --i)
    cell.erase(0, cell.find(',') + 1);
  EXPECT_EQ(std::stof(cell), frame.force_N[0]);
}

TEST(RecordingCsv, GivesEveryColumnAUnitOrNoneOnPurpose) {
  const std::string header = csv_header(test::make_header(3, 1, 3, 1));
  EXPECT_NE(header.find("force_x_N,"), std::string::npos);
  EXPECT_NE(header.find("worst_margin_us,"), std::string::npos);
  EXPECT_NE(
      header.find(
          "contact2_profile_10_m,contact2_tilt_x,contact2_tilt_y,contact2_tilt_z,contact2_state,"
          "contact2_state_name,"),
      std::string::npos);
}

}  // namespace tact::host::record::recording_test
