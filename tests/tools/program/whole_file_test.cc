// SPDX-License-Identifier: Apache-2.0
#include "tools/program/whole_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace tact::tools::program::whole_file_test {

namespace fs = std::filesystem;

class WholeFile : public testing::Test {
 protected:
  WholeFile() : folder_(testing::TempDir() + "tact-whole-" + std::to_string(getpid())) {
    fs::create_directories(folder_);
  }
  ~WholeFile() override { fs::remove_all(folder_); }

  const std::string folder_;
};

TEST_F(WholeFile, IsThereWholeOrNotAtAll) {
  ASSERT_TRUE(write_whole_file(folder_ + "/a.txt", "one"));
  ASSERT_TRUE(write_whole_file(folder_ + "/a.txt", "two"));
  EXPECT_EQ(*read_whole_file(folder_ + "/a.txt"), "two");
  EXPECT_FALSE(fs::exists(folder_ + "/a.txt.part"));
  EXPECT_FALSE(write_whole_file(folder_ + "/none/a.txt", "one"));
}

TEST_F(WholeFile, IsReadWholeAndAMissingOneIsNotAnEmptyOne) {
  std::string bytes(10'000, '\0');
  bytes += "\r\n\xff";
  for (const std::string& content : {std::string(), std::string("one"), bytes}) {
    ASSERT_TRUE(write_whole_file(folder_ + "/a.txt", content));
    const auto read = read_whole_file(folder_ + "/a.txt");
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, content);
  }
  for (const std::string& path : {folder_ + "/none.txt", folder_}) {
    const auto read = read_whole_file(path);
    ASSERT_FALSE(read) << path;
    EXPECT_EQ(read.error().sentence, path + ": cannot be read");
  }
}

}  // namespace tact::tools::program::whole_file_test
