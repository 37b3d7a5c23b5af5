// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/control_name.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "firmware/console/control_socket.h"
#include "model/io/socket_file.h"

namespace tact::firmware::console::control_name_test {

class ControlNames : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  void touch_file(const std::string& path) const { std::ofstream(path) << ""; }
  std::string folder = testing::TempDir() + "tact-names-" + std::to_string(getpid());
};

TEST_F(ControlNames, AreFoundByTheSceneUnderAnyPath) {
  const std::string scene = folder + "/liver.toml";
  touch_file(scene);
  for (const pid_t process : {41, 7}) touch_file(control_path(folder, scene, process));
  touch_file(control_path(folder, folder + "/other.toml", 8));
  const auto found = find_controls(
      folder, folder + "/../" + folder.substr(folder.rfind('/') + 1) + "/./liver.toml");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].process, 7);
  EXPECT_EQ(found[1].process, 41);
  EXPECT_EQ(found[1].path, control_path(folder, scene, 41));
  EXPECT_TRUE(find_controls(folder + "/none", scene).empty());
}

TEST_F(ControlNames, OnlySocketFilesOfDeadControllersAreRemoved) {
  const std::string dead = control_path(folder, "a.toml", 7), file = folder + "/control-x.sock.txt";
  touch_file(file);
  auto living = ControlSocket::open(control_path(folder, "a.toml", 8));
  ASSERT_TRUE(living) << living.error().message;
  {
    const auto address = model::io::socket_address(dead);
    const int fd = socket(AF_UNIX, SOCK_SEQPACKET, 0);
    ASSERT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&*address), sizeof *address), 0);
    ASSERT_EQ(listen(fd, 1), 0);
    close(fd);
  }
  remove_dead_controls(folder);
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(control_path(folder, "a.toml", 8)));
  EXPECT_TRUE(std::filesystem::exists(file));
}

TEST_F(ControlNames, APathThatIsTooLongIsRefusedWithTheRemedy) {
  const auto refused = ControlSocket::open(folder + "/" + std::string(120, 'x'));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("XDG_RUNTIME_DIR"), std::string::npos);
}

}  // namespace tact::firmware::console::control_name_test
