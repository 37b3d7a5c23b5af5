// SPDX-License-Identifier: Apache-2.0
#include "model/io/socket_file.h"

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tact::model::io::socket_file_test {

namespace fs = std::filesystem;
constexpr uid_t kStranger = 65534;  // the user nobody

class SocketFileTest : public ::testing::Test {
 protected:
  SocketFileTest() : folder_(testing::TempDir() + "tact-socket-" + std::to_string(getpid())) {
    fs::create_directory(folder_);
    chmod(folder_.c_str(), 0700);
  }
  ~SocketFileTest() override { fs::remove_all(folder_); }

  std::string path() const { return folder_ + "/a.sock"; }
  sockaddr_un address() const { return *socket_address(path()); }
  /// A socket with that name; the file stays when it is closed.
  int bind_one() const {
    const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    const sockaddr_un at = address();
    EXPECT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
    EXPECT_EQ(listen(fd, 1), 0);
    return fd;
  }
  std::string folder_;
};

TEST(SocketAddress, EmptyOrTooLongPathIsRefusedWithTheAllowedLength) {
  EXPECT_EQ(std::string(socket_address("/a")->sun_path), "/a");
  const std::string longest(sizeof(sockaddr_un::sun_path) - 1, 'a');
  EXPECT_EQ(std::string(socket_address(longest)->sun_path), longest);
  EXPECT_FALSE(socket_address(""));
  const auto refused = socket_address(longest + "a");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find(": a socket's path has 1 to 107 characters; give a "),
            std::string::npos)
      << refused.error().message;
}

TEST_F(SocketFileTest, GoesWithItsMakerUnlessAnotherIsThere) {
  const int first = bind_one();
  const SocketFile own(path());
  fs::rename(path(), path() + ".away");
  const int second = bind_one();
  own.remove();
  EXPECT_TRUE(fs::exists(path())) << "that is another's";
  SocketFile(path()).remove();
  EXPECT_FALSE(fs::exists(path()));
  fs::rename(path() + ".away", path());
  own.remove();
  EXPECT_FALSE(fs::exists(path()));
  close(first);
  close(second);
}

TEST_F(SocketFileTest, RemoveKeepsAFileThatIsNotASocket) {
  fclose(fopen(path().c_str(), "w"));
  SocketFile(path()).remove();
  EXPECT_TRUE(fs::exists(path()));
}

TEST_F(SocketFileTest, AFolderThatOthersMayWriteToIsRefused) {
  EXPECT_FALSE(check_socket_folder(path()));
  EXPECT_FALSE(check_socket_folder("/tmp/a.sock")) << "there, each keeps what is his";
  EXPECT_FALSE(check_socket_folder(folder_ + "/none/a.sock"));
  for (const mode_t mode : {0770u, 0702u, 0777u}) {
    ASSERT_EQ(chmod(folder_.c_str(), mode), 0);
    const auto refused = check_socket_folder(path());
    ASSERT_TRUE(refused) << mode;
    EXPECT_NE(refused->message.find("--socket"), std::string::npos);
  }
  EXPECT_TRUE(check_socket_folder("/dev/null/a.sock")) << "no folder";
}

TEST_F(SocketFileTest, AFolderOfAStrangerIsRefused) {
  if (geteuid() != 0) GTEST_SKIP() << "only root gives a folder away";
  ASSERT_EQ(chown(folder_.c_str(), kStranger, kStranger), 0);
  EXPECT_TRUE(check_socket_folder(path()));
  EXPECT_TRUE(check_socket_folder(path(), {.user = std::nullopt, .group = kStranger}));
  EXPECT_FALSE(check_socket_folder(path(), {.user = kStranger, .group = std::nullopt}));
}

TEST_F(SocketFileTest, ARuntimeFolderOfAStrangerIsRefusedWithARemedy) {
  if (geteuid() != 0) GTEST_SKIP() << "only root gives a folder away";
  ASSERT_EQ(setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1), 0);
  const std::string made = folder_ + "/tact";
  ASSERT_EQ(mkdir(made.c_str(), 0700), 0);
  ASSERT_EQ(chown(made.c_str(), kStranger, kStranger), 0);
  const auto refused = runtime_directory();
  unsetenv("XDG_RUNTIME_DIR");
  ASSERT_FALSE(refused);
  const std::string& message = refused.error().message;
  EXPECT_NE(message.find("user " + std::to_string(kStranger)), std::string::npos) << message;
  EXPECT_NE(message.find("set XDG_RUNTIME_DIR"), std::string::npos) << message;
  EXPECT_EQ(message.find("remove it and start again"), std::string::npos) << "forbidden in /tmp";
}

TEST_F(SocketFileTest, OnlyTheSameUserAndRootAreTrusted) {
  EXPECT_TRUE(is_trusted(geteuid()));
  EXPECT_TRUE(is_trusted(0));
  EXPECT_FALSE(is_trusted(geteuid() + 1));
}

/// Whether this process trusts one of `user` that connects.
bool is_trusted_peer(int listener, const sockaddr_un& at, uid_t user, const Trust& trust = {},
                     std::vector<gid_t> groups = {}) {
  const pid_t child = fork();
  if (child == 0) {
    const int fd = socket(AF_UNIX, SOCK_SEQPACKET, 0);
    const bool met = setgroups(groups.size(), groups.data()) == 0 && setgid(kStranger) == 0 &&
                     setuid(user) == 0 &&
                     connect(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0;
    _exit(met ? 0 : 1);
  }
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  const int met = accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
  EXPECT_GE(met, 0);
  const bool trusted = has_trusted_peer(met, trust);
  close(met);
  return trusted;
}

TEST_F(SocketFileTest, RootTrustsNoOtherUserAtTheOtherEnd) {
  if (geteuid() != 0) GTEST_SKIP() << "only root becomes another user";
  const int listener = bind_one();
  ASSERT_EQ(chmod(folder_.c_str(), 0755), 0);
  ASSERT_EQ(chmod(path().c_str(), 0777), 0);
  EXPECT_FALSE(is_trusted_peer(listener, address(), kStranger));
  EXPECT_TRUE(is_trusted_peer(listener, address(), 0));
  close(listener);
}

TEST_F(SocketFileTest, OnlyTheNamedUserIsTrusted) {
  if (geteuid() != 0) GTEST_SKIP() << "only root becomes another user";
  constexpr uid_t kOther = 65533;
  constexpr gid_t kViewers = 65532;
  const int listener = bind_one();
  ASSERT_EQ(chmod(folder_.c_str(), 0755), 0);
  ASSERT_EQ(chmod(path().c_str(), 0777), 0);
  const Trust user{.user = kStranger, .group = std::nullopt};
  EXPECT_TRUE(is_trusted_peer(listener, address(), kStranger, user));
  EXPECT_FALSE(is_trusted_peer(listener, address(), kOther, user));
  const Trust viewers{.user = std::nullopt, .group = kViewers};
  EXPECT_TRUE(is_trusted_peer(listener, address(), kOther, viewers, {7, kViewers}));
  EXPECT_FALSE(is_trusted_peer(listener, address(), kOther, viewers, {7}));
  const Trust own_group{.user = std::nullopt, .group = kStranger};
  EXPECT_TRUE(is_trusted_peer(listener, address(), kOther, own_group)) << "the first group, too";
  close(listener);
}

TEST_F(SocketFileTest, IsBoundForItsUserAloneUnderAnyUmask) {
  const mode_t before = umask(0);
  const auto fd = bind_socket(path(), SOCK_SEQPACKET | SOCK_CLOEXEC);
  umask(before);
  ASSERT_TRUE(fd) << fd.error().message;
  struct stat info{};
  ASSERT_EQ(stat(path().c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777u, 0600u);
  close(*fd);
}

TEST_F(SocketFileTest, OnlyADeadSocketIsReplaced) {
  for (const int type : {SOCK_SEQPACKET | SOCK_CLOEXEC, SOCK_DGRAM | SOCK_CLOEXEC}) {
    const auto dead = bind_socket(path(), type);
    ASSERT_TRUE(dead) << dead.error().message;
    close(*dead);  // its file stays
    const auto living = bind_socket(path(), type);
    ASSERT_TRUE(living) << living.error().message;
    listen(*living, 1);
    const auto second = bind_socket(path(), type);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("--socket"), std::string::npos);
    close(*living);
    fs::remove(path());
  }
  fclose(fopen(path().c_str(), "w"));
  EXPECT_FALSE(bind_socket(path(), SOCK_SEQPACKET | SOCK_CLOEXEC));
  EXPECT_TRUE(fs::is_regular_file(path()));
}

TEST_F(SocketFileTest, ASocketIsSharedWithOneGroupAndAFileIsNot) {
  const int listener = bind_one();
  EXPECT_FALSE(share_socket(path(), getegid()));
  struct stat info{};
  ASSERT_EQ(stat(path().c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777u, 0660u);
  close(listener);
  fs::remove(path());
  fclose(fopen(path().c_str(), "w"));
  EXPECT_TRUE(share_socket(path(), getegid()));
  EXPECT_EQ(find_group("root").value(), 0u);
  EXPECT_FALSE(find_group("no-such-group"));
  EXPECT_EQ(find_user("root").value(), 0u);
  EXPECT_FALSE(find_user("no-such-user"));
}

}  // namespace tact::model::io::socket_file_test
