// SPDX-License-Identifier: Apache-2.0
#include "model/io/input_file.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/model/io/scratch.h"

namespace tact::model::io::input_file_test {

class InputFileTest : public Scratch {
 protected:
  std::string refusal(const std::string& path) {
    const auto read = read_file(path, "name another");
    EXPECT_FALSE(read) << path;
    return read ? std::string() : read.error().message;
  }
};

TEST_F(InputFileTest, IsReadWholeForAnyContent) {
  std::string bytes(200'000, '\0');
  bytes += "\r\n\xff";
  for (const std::string& content : {std::string(), std::string("one"), bytes}) {
    put("a", content);
    const auto read = read_file(path("a"));
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, content);
  }
}

TEST_F(InputFileTest, ProcFileWithoutASizeIsReadToItsEnd) {
  const auto read = read_file("/proc/self/status");
  ASSERT_TRUE(read);
  EXPECT_NE(read->find("VmPeak"), std::string::npos);
}

TEST_F(InputFileTest, DirectoriesPipesSocketsAndDevicesAreRefusedAtOnce) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);  // a read would wait for ever
  const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  path("socket").copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(refusal(folder()), folder() + ": this is a directory; name another");
  EXPECT_EQ(refusal(path("pipe")),
            path("pipe") + ": this is a pipe, not a regular file; name another");
  EXPECT_NE(refusal(path("socket")).find("this is a socket"), std::string::npos);
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: this is a device, not a regular file; name another");
  EXPECT_EQ(refusal(path("none")), path("none") + ": no such file; name another");
  EXPECT_EQ(refusal(""), ": no such file; name another");
  close(fd);
}

TEST_F(InputFileTest, LargerThanAllowedIsRefused) {
  put("a", std::string(1001, 'x'));
  EXPECT_TRUE(read_file(path("a"), "cut it", 1001));
  const auto read = read_file(path("a"), "cut it", 1000);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, path("a") + ": larger than 1000 bytes; cut it");
  EXPECT_FALSE(read_file("/proc/self/status", "cut it", 10));  // which says no size
}

TEST_F(InputFileTest, AReadThatFailsIsReportedAndGivesNoShorterText) {
  // A page of our memory that is not mapped: the file is regular, the read gives EIO.
  const auto read = read_file("/proc/self/mem");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("cannot be read to its end"), std::string::npos);
}

}  // namespace tact::model::io::input_file_test
