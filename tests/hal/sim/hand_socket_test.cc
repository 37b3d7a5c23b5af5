// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/hand_socket.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <thread>

namespace tact::hal::sim::hand_socket_test {

std::string fresh_path(const char* name) {
  const std::string path =
      testing::TempDir() + "tact-" + name + "-" + std::to_string(getpid()) + ".sock";
  unlink(path.c_str());
  return path;
}
sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  return address;
}
void send_bytes(const std::string& path, const void* bytes, std::size_t size) {
  const int sender = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_un address = address_of(path);
  EXPECT_EQ(
      sendto(sender, bytes, size, 0, reinterpret_cast<const sockaddr*>(&address), sizeof address),
      static_cast<ssize_t>(size));
  close(sender);
}
bool wait_for(threads::LatestSlot<HandTarget>& slot, HandTarget& target) {
  for (int i = 0; i < 400; ++i) {
    if (slot.read(target)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}
HandTarget at(double x_m) {
  return {.position_m = {x_m, 0.02, -0.03}, .rotation_rad = {0.1, 0.0, -0.2}, .grip_ratio = 0.5};
}

TEST(HandSocket, PassesTheNewestTarget) {
  const std::string path = fresh_path("pass");
  threads::LatestSlot<HandTarget> slot;
  auto listener = HandSocket::start(path, slot);
  ASSERT_TRUE(listener) << listener.error().message;
  const HandTarget sent = at(0.01);
  send_bytes(path, &sent, sizeof sent);
  HandTarget seen;
  ASSERT_TRUE(wait_for(slot, seen));
  EXPECT_EQ(std::memcmp(&seen, &sent, sizeof sent), 0);
}

TEST(HandSocket, IsTheOwnersAloneAndLeavesNothingBehind) {
  const std::string path = fresh_path("mode");
  threads::LatestSlot<HandTarget> slot;
  auto listener = HandSocket::start(path, slot);
  ASSERT_TRUE(listener) << listener.error().message;
  struct stat status{};
  ASSERT_EQ(stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
  (*listener)->stop();
  (*listener)->stop();
  EXPECT_NE(stat(path.c_str(), &status), 0);
}

TEST(HandSocket, IgnoresGarbage) {
  const std::string path = fresh_path("garbage");
  threads::LatestSlot<HandTarget> slot;
  auto listener = HandSocket::start(path, slot);
  ASSERT_TRUE(listener) << listener.error().message;
  HandTarget magic = at(0.1), version = at(0.1), far = at(50.0), nan = at(0.1), grip = at(0.1);
  HandTarget turn = at(0.1);
  magic.magic = 1;
  version.version = 1;
  nan.position_m[2] = std::numeric_limits<double>::quiet_NaN();
  // Each component is within pi, the turn is not.
  turn.rotation_rad[0] = turn.rotation_rad[1] = 3.0;
  grip.grip_ratio = std::numeric_limits<double>::infinity();
  for (const HandTarget& bad : {magic, version, far, nan, turn, grip}) {
    EXPECT_FALSE(is_sound(bad));
    send_bytes(path, &bad, sizeof bad);
  }
  HandTarget good = at(0.07);
  good.rotation_rad[0] = good.rotation_rad[2] = 0.0;
  good.rotation_rad[1] = std::numbers::pi;
  unsigned char longer[sizeof good + 8] = {};
  std::memcpy(longer, &good, sizeof good);
  send_bytes(path, longer, sizeof longer);
  send_bytes(path, &good, sizeof good - 8);
  send_bytes(path, &good, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(150));  // three rounds of the listener
  HandTarget seen;
  EXPECT_FALSE(slot.read(seen));
  send_bytes(path, &good, sizeof good);
  ASSERT_TRUE(wait_for(slot, seen));
  EXPECT_EQ(seen.position_m[0], 0.07);
}

TEST(HandSocket, ReplacesASocketWithoutAListener) {
  const std::string path = fresh_path("stale");
  const int dead = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_un address = address_of(path);
  ASSERT_EQ(bind(dead, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(dead);
  threads::LatestSlot<HandTarget> slot;
  const auto listener = HandSocket::start(path, slot);
  EXPECT_TRUE(listener) << listener.error().message;
}

TEST(HandSocket, LeavesALivingListenerAndAFileAlone) {
  const std::string path = fresh_path("taken");
  threads::LatestSlot<HandTarget> slot, other;
  const auto listener = HandSocket::start(path, slot);
  ASSERT_TRUE(listener);
  const auto second = HandSocket::start(path, other);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find(path), std::string::npos);

  const std::string file = fresh_path("file");
  close(open(file.c_str(), O_CREAT | O_WRONLY, 0600));
  EXPECT_FALSE(HandSocket::start(file, other));
  struct stat status{};
  EXPECT_EQ(stat(file.c_str(), &status), 0);
  unlink(file.c_str());
}

TEST(HandSocket, LeavesTheFileOfTheNextOneWhenItEnds) {
  const std::string path = fresh_path("next");
  threads::LatestSlot<HandTarget> slot;
  const auto first = HandSocket::start(path, slot);
  ASSERT_TRUE(first);
  unlink(path.c_str());
  const auto second = HandSocket::start(path, slot);
  ASSERT_TRUE(second);
  (*first)->stop();
  struct stat status{};
  EXPECT_EQ(stat(path.c_str(), &status), 0);
}

TEST(HandSocket, SaysWhatIsWrongWithAPath) {
  threads::LatestSlot<HandTarget> slot;
  EXPECT_FALSE(HandSocket::start("", slot));
  EXPECT_FALSE(HandSocket::start(std::string(200, 'x'), slot));
  const auto missing = HandSocket::start("/nonexistent/place/hand.sock", slot);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("/nonexistent/place/hand.sock"), std::string::npos);
}

}  // namespace tact::hal::sim::hand_socket_test
