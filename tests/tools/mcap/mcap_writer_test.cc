// SPDX-License-Identifier: Apache-2.0
// The bytes of a small file, by hand from https://mcap.dev/spec. Foxglove's own readers judge whole
// files in tests/tools/mcap/mcap_test.py.
#include "tools/mcap/mcap_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/sentence.h"

namespace tact::tools::mcap::mcap_writer_test {

using tests::sentence_of;

const std::string kMagic = "\x89MCAP0\r\n";

class File : public testing::Test {
 protected:
  File() : path_(testing::TempDir() + "tact-mcap-writer-" + std::to_string(getpid()) + ".mcap") {}
  ~File() override { std::filesystem::remove(path_); }

  std::string content() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Little-endian, at this byte.
  template <typename T>
  static T number(const std::string& bytes, std::size_t at) {
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }

  std::string path_;
  const Schema schema_{"s", "ros2msg", "uint8 a\n", "cdr"};
};

TEST_F(File, BeginsAndEndsAsTheSpecificationSays) {
  auto writer = McapWriter::create(path_, "ros2", "tact");
  ASSERT_EQ(sentence_of(writer), "");
  const std::uint16_t channel = writer->add_channel("/t", schema_);
  EXPECT_EQ(channel, 0);
  EXPECT_EQ(writer->add_channel("/u", schema_), 1);
  ASSERT_EQ(sentence_of(writer->put(channel, 7, "abc")), "");
  ASSERT_EQ(sentence_of(writer->finish()), "");
  const std::string bytes = content();
  EXPECT_EQ(bytes.substr(0, 8), kMagic);
  const char header[] = "\x01\x10\0\0\0\0\0\0\0\x04\0\0\0ros2\x04\0\0\0tact";
  EXPECT_EQ(bytes.substr(8, 25), std::string(header, 25));
  EXPECT_EQ(bytes.substr(bytes.size() - 8), kMagic);
  const std::size_t footer = bytes.size() - 8 - 20 - 9;
  EXPECT_EQ(bytes[footer], 0x02);
  EXPECT_EQ(number<std::uint64_t>(bytes, footer + 1), 20u);
  const auto summary = number<std::uint64_t>(bytes, footer + 9);
  EXPECT_EQ(bytes[summary - 13], 0x0f);
  EXPECT_EQ(bytes[summary], 0x03) << "its first group: schemas";
  EXPECT_EQ(bytes[number<std::uint64_t>(bytes, footer + 17)], 0x0e);
  boost::crc_32_type data, all;
  data.process_bytes(bytes.data(), summary - 13);
  EXPECT_EQ(number<std::uint32_t>(bytes, summary - 4), data.checksum());
  all.process_bytes(bytes.data() + summary, footer + 25 - summary);
  EXPECT_EQ(number<std::uint32_t>(bytes, footer + 25), all.checksum());
  const char message[] =
      "\x05\x19\0\0\0\0\0\0\0\0\0\0\0\0\0\x07\0\0\0\0\0\0\0\x07\0\0\0\0\0\0\0abc";
  EXPECT_NE(bytes.find(std::string(message, 9 + 25)), std::string::npos);
}

TEST_F(File, IsNotThereBeforeItsEnd) {
  {
    auto writer = McapWriter::create(path_, "ros2", "tact");
    ASSERT_EQ(sentence_of(writer), "");
    const std::uint16_t channel = writer->add_channel("/t", schema_);
    for (int i = 0; i < 3; ++i)
      ASSERT_EQ(sentence_of(writer->put(channel, 1, std::string(600'000, 'x'))), "");
    EXPECT_FALSE(std::filesystem::exists(path_));
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(File, ReplacesAnotherSuchFileAndNothingElse) {
  std::ofstream(path_, std::ios::binary) << kMagic << "old";
  EXPECT_EQ(sentence_of(McapWriter::create(path_, "ros2", "tact")), "");
  std::ofstream(path_, std::ios::binary) << "name = \"my scene\"\n";
  EXPECT_NE(sentence_of(McapWriter::create(path_, "ros2", "tact")), "");
  EXPECT_EQ(content(), "name = \"my scene\"\n");
}

}  // namespace tact::tools::mcap::mcap_writer_test
