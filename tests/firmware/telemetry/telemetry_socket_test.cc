// SPDX-License-Identifier: Apache-2.0
// Whose socket it is, and who may listen at it.
#include "firmware/telemetry/telemetry_socket.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/protocol/run_file.h"

namespace tact::firmware::telemetry::telemetry_socket_test {

class OwnFolder : public ::testing::Test {
 protected:
  OwnFolder() : folder_("/tmp/tact-own-" + std::to_string(getpid())), path_(folder_ + "/t.sock") {
    mkdir(folder_.c_str(), 0700);
  }
  ~OwnFolder() override { std::filesystem::remove_all(folder_); }
  std::string folder_, path_;
};

TEST_F(OwnFolder, ATactdThatLeavesKeepsTheSocketOfTheNextOne) {
  auto first = std::make_optional(TelemetrySocket::open(path_, -1));
  ASSERT_TRUE(*first);
  unlink(path_.c_str());
  auto second = std::make_optional(TelemetrySocket::open(path_, -1));
  ASSERT_TRUE(*second);
  first.reset();
  EXPECT_TRUE(std::filesystem::exists(path_));
  second.reset();
  EXPECT_FALSE(std::filesystem::exists(path_));
}

/// A client that waits for nothing; -1 if it is refused.
int connect_to(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0);
  if (connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) return fd;
  close(fd);
  return -1;
}

TEST_F(OwnFolder, ServesThirtyTwoClientsAndRefusesTheNext) {
  auto socket_of_tactd = TelemetrySocket::open(path_, dup(0));
  ASSERT_TRUE(socket_of_tactd);
  std::vector<int> clients(TelemetrySocket::kMaxClients + 1);
  for (int& client : clients) ASSERT_GE(client = connect_to(path_), 0) << "all in one frame";
  socket_of_tactd->send("a frame");
  for (const int client : clients) {
    const bool is_last = client == clients.back();
    char bytes[64] = {};
    const ssize_t size = recv(client, bytes, sizeof bytes, 0);
    ASSERT_GT(size, 0);
    EXPECT_EQ(std::string_view(bytes, static_cast<std::size_t>(size)),
              is_last ? protocol::kFull : protocol::kMagic);
    EXPECT_EQ(recv(client, bytes, sizeof bytes, 0), is_last ? 0 : 7);
    close(client);
  }
  socket_of_tactd->send("a frame");  // sees that they have gone
  const int next = connect_to(path_);
  socket_of_tactd->send("a frame");
  char letter = 0;
  EXPECT_EQ(recv(next, &letter, 1, 0), 1);
  EXPECT_EQ(letter, protocol::kMagic[0]);
  close(next);
}

TEST_F(OwnFolder, AFolderInWhichOthersCouldPutASocketIsRefused) {
  ASSERT_EQ(chmod(folder_.c_str(), 0777), 0);
  const auto refused = TelemetrySocket::open(path_, -1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("another user may put a socket there"), std::string::npos);
}

/// Whether one of `user` gets anything at the socket.
bool is_heard_by(uid_t user, TelemetrySocket& socket_of_tactd, const std::string& path) {
  int go[2];
  EXPECT_EQ(pipe(go), 0);
  const pid_t child = fork();
  if (child == 0) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    const int fd = socket(AF_UNIX, SOCK_SEQPACKET, 0);
    const bool met = setuid(user) == 0 &&
                     connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    char word = 0;
    if (!met || write(go[1], "x", 1) != 1) _exit(2);
    _exit(recv(fd, &word, 1, 0) > 0 ? 0 : 1);
  }
  char word = 0;
  EXPECT_EQ(read(go[0], &word, 1), 1);
  socket_of_tactd.send("a frame");
  int status = 0;
  waitpid(child, &status, 0);
  close(go[0]);
  close(go[1]);
  return WEXITSTATUS(status) == 0;
}

TEST_F(OwnFolder, AnotherUserHearsNothingEvenIfTheFileLetsHimIn) {
  if (geteuid() != 0) GTEST_SKIP() << "only root becomes another user";
  const int meshes = dup(0);  // any file: it is not read
  auto socket_of_tactd = TelemetrySocket::open(path_, meshes);
  ASSERT_TRUE(socket_of_tactd);
  ASSERT_EQ(chmod(folder_.c_str(), 0755), 0);
  ASSERT_EQ(chmod(path_.c_str(), 0777), 0);
  EXPECT_FALSE(is_heard_by(65534, *socket_of_tactd, path_));
  EXPECT_TRUE(is_heard_by(0, *socket_of_tactd, path_));
}

}  // namespace tact::firmware::telemetry::telemetry_socket_test
