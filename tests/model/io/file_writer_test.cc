// SPDX-License-Identifier: Apache-2.0
#include "model/io/file_writer.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "tests/model/io/scratch.h"

namespace tact::model::io::file_writer_test {

namespace fs = std::filesystem;

class FileWriterTest : public Scratch {};

std::string message_of(const std::optional<Error>& error) {
  return error ? error->message : std::string();
}

TEST_F(FileWriterTest, AResultReplacesAnEarlierResult) {
  EXPECT_EQ(message_of(write_file(path("a.json"), "{\"a\": 1}\n")), "");
  EXPECT_EQ(message_of(write_file(path("a.json"), "{\n \"b\": 2}\n")), "");
  EXPECT_EQ(text("a.json"), "{\n \"b\": 2}\n");
  put("a.csv", "job,law,depth_m\n1,rhombus,2\n");
  EXPECT_EQ(message_of(write_file(path("a.csv"), "job,depth_m\n")), "");
  put("b.csv", "# command: build/tact-lab chart\n");
  EXPECT_EQ(message_of(write_file(path("b.csv"), "# command: ./tact-lab chart\n")), "");
  put("empty.toml", "");
  EXPECT_EQ(message_of(write_file(path("empty.toml"), "{}\n")), "");
  EXPECT_EQ(files(), 4u);
}

TEST_F(FileWriterTest, FilesOfOtherKindsAreKeptAndNamed) {
  const std::pair<const char*, const char*> kept[] = {
      {"scene.toml", "# Liver, pressed by forceps\nname = \"liver\"\n"},
      {"bare.toml", "[device]\nkind = \"sim\"\n"},
      {"mesh.obj", "v 0 0 0\n"},
      {"other.csv", "time_s,force_N\n"}};
  for (const auto& [name, content] : kept) {
    put(name, content);
    for (const char* bytes :
         {"{\n}\n", "job,law\n", "# command: tact-lab chart\n", "<!doctype html>", ""}) {
      EXPECT_EQ(message_of(write_file(path(name), bytes)),
                path(name) +
                    ": holds something else than what would be written, and is kept; name another "
                    "file, or remove this one");
      EXPECT_EQ(message_of(check_target(path(name), bytes)),
                message_of(write_file(path(name), bytes)));
    }
    EXPECT_EQ(text(name), content);
  }
  EXPECT_EQ(files(), 4u);
}

TEST_F(FileWriterTest, AFileOfAnotherKindIsRefused) {
  EXPECT_EQ(message_of(write_file(folder(), "{}")),
            folder() + ": this is a directory; name a file");
  EXPECT_NE(message_of(write_file(path("none/a"), "{}")).find("No such file or directory"),
            std::string::npos);
  ASSERT_EQ(symlink(path("nowhere").c_str(), path("link").c_str()), 0);
  EXPECT_NE(message_of(write_file(path("link"), "{}")), "");
  EXPECT_NE(message_of(write_file("", "{}")), "");
}

TEST_F(FileWriterTest, APipeIsWrittenStraightAndNotWaitedForWithoutAReader) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(message_of(write_file(path("pipe"), "one")),
            path("pipe") + ": this pipe has no reader; start its reader first");
  std::string got;
  std::thread reader([&] { got = text("pipe"); });
  std::optional<Error> error;
  do error = write_file(path("pipe"), std::string(200'000, 'x'));  // until the reader is there
  while (error && error->message.find("has no reader") != std::string::npos);
  reader.join();
  EXPECT_EQ(message_of(error), "");
  EXPECT_EQ(got.size(), 200'000u);
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

TEST_F(FileWriterTest, ADeviceWithoutRoomIsReported) {
  EXPECT_NE(message_of(write_file("/dev/full", "{}")).find("No space left on device"),
            std::string::npos);
  EXPECT_EQ(message_of(write_file("/dev/null", "{}")), "");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(FileWriterTest, AFullDiskKeepsTheOldFileAndLeavesNoPart) {
  put("a.json", "{\"old\": 1}");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{.rlim_cur = 1000, .rlim_max = before.rlim_max};
  const auto old = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const auto error = write_file(path("a.json"), "{" + std::string(100'000, ' ') + "}");
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, old);
  EXPECT_NE(message_of(error).find("File too large"), std::string::npos);
  EXPECT_EQ(text("a.json"), "{\"old\": 1}");
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileWriterTest, ALinkStaysAndItsFileIsReplacedWithItsRights) {
  put("a.json", "{}");
  ASSERT_EQ(chmod(path("a.json").c_str(), 0640), 0);
  ASSERT_EQ(symlink(path("a.json").c_str(), path("link.json").c_str()), 0);
  EXPECT_EQ(message_of(write_file(path("link.json"), "{\"new\": 1}")), "");
  EXPECT_TRUE(fs::is_symlink(path("link.json")));
  EXPECT_EQ(text("a.json"), "{\"new\": 1}");
  EXPECT_EQ(fs::status(path("a.json")).permissions(), fs::perms(0640));
}

TEST_F(FileWriterTest, UnfinishedFileLeavesNothing) {
  {
    auto writer = FileWriter::replace(path("a.json"), "{");
    ASSERT_TRUE(writer);
    EXPECT_EQ(message_of(writer->put("{")), "");
    EXPECT_EQ(message_of(writer->flush()), "");
    EXPECT_FALSE(fs::exists(path("a.json")));
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(FileWriterTest, GrowingFileIsVisibleAtOnceAndNeverOverwritten) {
  auto writer = FileWriter::create(path("log"));
  ASSERT_TRUE(writer);
  EXPECT_EQ(message_of(writer->put("one")), "");
  EXPECT_EQ(message_of(writer->flush()), "");
  EXPECT_EQ(text("log"), "one");
  EXPECT_EQ(message_of(writer->finish()), "");
  const auto again = FileWriter::create(path("log"));
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("never overwritten"), std::string::npos);
  EXPECT_EQ(text("log"), "one");
}

}  // namespace tact::model::io::file_writer_test
