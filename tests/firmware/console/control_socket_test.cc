// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/control_socket.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <thread>

#include "firmware/console/control_client.h"
#include "firmware/console/control_name.h"
#include "model/io/socket_file.h"
#include "tests/support/forked.h"
#include "tests/support/message.h"

namespace tact::firmware::console::control_socket_test {

class Control : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder);
    socket = std::move(*ControlSocket::open(path));
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  int connect_here() const {
    const auto address = model::io::socket_address(path);
    const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    EXPECT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&*address), sizeof *address), 0);
    return fd;
  }
  /// A request that is complete.
  std::optional<ControlRequest> ask(const char* word) {
    const int fd = connect_here();
    EXPECT_GE(send(fd, word, strlen(word), 0), 0);
    close(fd);
    return socket->next();
  }
  std::string folder = testing::TempDir() + "tact-control-" + std::to_string(getpid());
  std::string path = control_path(folder, "liver.toml", getpid());
  std::unique_ptr<ControlSocket> socket;
};

TEST_F(Control, EachCommandGetsOneAnswer) {
  Answer answer;
  std::thread person([&] {
    auto got = ask_tactd({.folder = folder, .scene_path = "liver.toml", .word = "arm"});
    answer = got ? *got : Answer{.done = false, .message = got.error().message};
  });
  std::string word;
  while (word.empty()) {
    const auto request = socket->next();
    if (!request) continue;
    word = request->word();
    request->answer({.done = true, .message = "puppet: armed"});
  }
  person.join();
  EXPECT_EQ(word, "arm");
  EXPECT_TRUE(answer.done);
  EXPECT_EQ(answer.message, "puppet: armed");
}

TEST_F(Control, AClientThatLeavesAtOnceIsAnsweredAndHarmsNothing) {
  const auto request = ask("stop");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->word(), "stop");
  request->answer({.done = true, .message = "no client listens"});
  EXPECT_FALSE(socket->next());
}

TEST_F(Control, SilentClientsDoNotBlockARequest) {
  std::vector<int> silent;
  for (int i = 0; i < 100; ++i) {
    silent.push_back(connect_here());
    EXPECT_FALSE(socket->next());
  }
  EXPECT_TRUE(ask("status"));
  for (const int fd : silent) close(fd);
  EXPECT_FALSE(socket->next());
}

TEST_F(Control, EmptyCommandIsDroppedAndALongOneIsCutToTheLimit) {
  EXPECT_FALSE(ask(""));
  const auto request = ask(std::string(5000, 'x').c_str());
  ASSERT_TRUE(request);
  EXPECT_LE(request->word().size(), kLongestControlMessage);
}

// In a process of its own, whose limit stays low.
TEST_F(Control, HearsAClientWithoutAFreeDescriptor) {
  const auto hear_two = [this] {
    socket->next();  // which takes its spare one
    const int first = connect_here(), second = connect_here();
    send(first, "stop", 4, 0);
    send(second, "status", 6, 0);
    const rlimit none{.rlim_cur = static_cast<rlim_t>(second) + 1,
                      .rlim_max = static_cast<rlim_t>(second) + 1};
    setrlimit(RLIMIT_NOFILE, &none);
    std::string heard;
    for (int i = 0; i < 4; ++i)
      if (const auto request = socket->next()) heard += request->word() + " ";
    _exit(heard == "stop status " ? 7 : 8);
  };
  EXPECT_EXIT(hear_two(), testing::ExitedWithCode(7), "");
}

TEST_F(Control, IsOpenToItsOwnerAlone) {
  struct stat info{};
  ASSERT_EQ(stat(path.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777u, 0600u);
}

// As far as the kernel lets a stranger come: folder and file are closed to him as well.
TEST_F(Control, AStrangerIsRefused) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can play a stranger";
  ASSERT_EQ(chmod(folder.c_str(), 0777), 0);
  ASSERT_EQ(chmod(path.c_str(), 0777), 0);
  const tests::Forked stranger([&] {
    if (setuid(65'534) != 0) return;
    const int fd = connect_here();
    send(fd, "arm", 3, 0);
  });
  EXPECT_FALSE(socket->next());
  EXPECT_FALSE(socket->next());
}

TEST_F(Control, RefusedUserIsShownTheOwnerOfTheProcess) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can play a stranger";
  const auto ask_as_stranger = [this](const std::string& wanted) {
    if (setuid(65'534) != 0) _exit(9);
    const auto reported = ask_tactd({.folder = folder, .scene_path = "liver.toml", .word = "arm"});
    const auto says = [&](const std::string& words) {
      return !reported && reported.error().message.find(words) != std::string::npos;
    };
    if (!reported) fprintf(stderr, "%s\n", reported.error().message.c_str());
    _exit(says(wanted) && says("sudo tactctl") && !says("start one") ? 7 : 8);
  };
  ASSERT_EQ(chmod(folder.c_str(), 0755), 0);
  const std::string pid = std::to_string(getpid());
  EXPECT_EXIT(ask_as_stranger("it runs as root (pid " + pid + "); you may not ask it"),
              testing::ExitedWithCode(7), "");
  ASSERT_EQ(chmod(folder.c_str(), 0700), 0);
  EXPECT_EXIT(ask_as_stranger("is closed to you"), testing::ExitedWithCode(7), "");
}

TEST_F(Control, LeavesTheFileOfAnother) {
  const std::string mine = path + ".mine";
  std::filesystem::rename(path, mine);
  auto other = ControlSocket::open(path);
  ASSERT_TRUE(other);
  socket.reset();
  EXPECT_TRUE(std::filesystem::exists(path)) << "of the other";
  other->reset();
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Control, AFileThatADeadOneLeftIsReplaced) {
  std::filesystem::rename(path, path + ".dead");
  socket.reset();
  std::filesystem::rename(path + ".dead", path);
  auto next = ControlSocket::open(path);
  ASSERT_TRUE(next) << tests::message_of(next);
  socket = std::move(*next);
  EXPECT_TRUE(ask("status"));
}

TEST_F(Control, ClientReportsMissingSeveralAndSilentControllers) {
  const ControlQuestion question{.folder = folder, .scene_path = "liver.toml", .word = "arm"};
  ControlQuestion other = question;
  other.scene_path = "skin.toml";
  EXPECT_NE(tests::message_of(ask_tactd(other)).find("no tactd runs skin.toml"), std::string::npos);
  auto second = ControlSocket::open(control_path(folder, "liver.toml", 1));
  ASSERT_TRUE(second);
  const std::string several = tests::message_of(ask_tactd(question));
  EXPECT_NE(several.find("processes 1 and " + std::to_string(getpid())), std::string::npos)
      << several;
  ControlQuestion one = question;
  one.process = 1;
  EXPECT_NE(tests::message_of(ask_tactd(one)).find("process 1 does not answer"), std::string::npos);
}

}  // namespace tact::firmware::console::control_socket_test
