// A file of observations: what is kept of it, and what is refused.
#include "host/tracking/observation_player.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace tact::host {
namespace {

namespace fs = std::filesystem;

class RecordingFile : public ::testing::Test {
 protected:
  RecordingFile() : path_(fs::temp_directory_path() / ("tact-seen-" + std::to_string(getpid()))) {
    std::ofstream(path_) << kLine << "\n";
  }
  ~RecordingFile() override { fs::remove(path_); }

  const std::string kLine =
      R"({"time_s":1.5,"sequence":3,"camera":"front","body":"head","points":[[0,1.0,2.0]]})";
  fs::path path_;
  ObservationFile file_;
};

TEST_F(RecordingFile, KeepsItsTextOnlyForWhoSendsItOn) {
  ASSERT_EQ(read_observation_file(path_, file_), "");
  ASSERT_EQ(file_.lines.size(), 1u);
  EXPECT_EQ(file_.lines[0].text, "");
  EXPECT_EQ(file_.lines[0].seen.time_s, 1.5);
  file_ = {};
  ASSERT_EQ(read_observation_file(path_, file_, KeepText::kYes), "");
  EXPECT_EQ(file_.lines.at(0).text, kLine);
}

TEST_F(RecordingFile, LargerThan64MegabytesIsRefusedInOneLine) {
  fs::resize_file(path_, kLargestRecording_bytes + 1);  // takes no room on the disk
  EXPECT_EQ(read_observation_file(path_, file_),
            path_.string() + ": larger than 64 MB; cut it into parts");
  EXPECT_TRUE(file_.lines.empty());
}

}  // namespace
}  // namespace tact::host
