// SPDX-License-Identifier: Apache-2.0
// A file of observations: what is kept of it, and what is refused.
#include "host/tracking/observation_player.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/support/message.h"

namespace tact::host::tracking::observation_player_test {

using tests::message_of;

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
};

TEST_F(RecordingFile, LargerThan64MegabytesIsRefusedInOneLine) {
  fs::resize_file(path_, kMaxRecording_bytes + 1);  // takes no room on the disk
  EXPECT_EQ(message_of(read_observation_file(path_)),
            path_.string() +
                ": larger than 64000000 bytes; give a file of observations, one per line; cut a "
                "larger one into parts");
}

}  // namespace tact::host::tracking::observation_player_test
