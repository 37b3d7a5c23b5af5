// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/service_manager.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "model/io/socket_file.h"

namespace tact::firmware::console::service_manager_test {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// The manager's end of the socket, as systemd hands it to a service.
class Service : public testing::Test {
 protected:
  Service() : path_(testing::TempDir() + "tact-notify-" + std::to_string(getpid())) {
    std::filesystem::remove(path_);
    listener_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const auto address = model::io::socket_address(path_);
    EXPECT_EQ(bind(listener_, reinterpret_cast<const sockaddr*>(&*address), sizeof *address), 0);
    setenv("NOTIFY_SOCKET", path_.c_str(), 1);
  }
  ~Service() override {
    unsetenv("NOTIFY_SOCKET");
    close(listener_);
    std::filesystem::remove(path_);
  }

  /// The next datagram; empty if there is none.
  std::string heard() const {
    std::array<char, 500> words{};
    const auto n = recv(listener_, words.data(), words.size(), 0);
    return n > 0 ? std::string(words.data(), static_cast<std::size_t>(n)) : "";
  }

  std::string path_;
  int listener_ = -1;
};

TEST_F(Service, ReadinessIsReportedOnceWhenArmingIsAllowed) {
  ServiceManager manager;
  manager.report({.now_ns = 0, .may_be_armed = false, .ticks = 0, .status = "off"});
  EXPECT_EQ(heard(), "STATUS=off\n");
  manager.report({.now_ns = 1, .may_be_armed = true, .ticks = 0, .status = "ready"});
  EXPECT_EQ(heard(), "READY=1\nSTATUS=ready\n");
  manager.report({.now_ns = 2 * kSecond_ns, .may_be_armed = false, .ticks = 0, .status = "armed"});
  manager.report({.now_ns = 4 * kSecond_ns, .may_be_armed = true, .ticks = 0, .status = "ready"});
  EXPECT_EQ(heard(), "STATUS=armed\n");
  EXPECT_EQ(heard(), "STATUS=ready\n");
}

TEST_F(Service, FeedsTheWatchdogOnlyWhileTheLoopTicks) {
  ServiceManager manager;
  std::int64_t now_ns = 0;
  for (const std::uint64_t ticks : {1000u, 2000u, 2000u, 2000u, 2001u})
    manager.report({.now_ns = now_ns += kSecond_ns, .ticks = ticks});
  for (const char* words : {"WATCHDOG=1\nSTATUS=\n", "WATCHDOG=1\nSTATUS=\n", "STATUS=\n",
                            "STATUS=\n", "WATCHDOG=1\nSTATUS=\n"})
    EXPECT_EQ(heard(), words);
}

TEST_F(Service, GetsOneReportASecondHoweverOftenItIsCalled) {
  ServiceManager manager;
  for (int i = 0; i < 10; ++i) manager.report({.now_ns = i * kSecond_ns / 5, .status = "off"});
  for (int i = 0; i < 2; ++i) EXPECT_EQ(heard(), "STATUS=off\n");
  EXPECT_EQ(heard(), "");
}

TEST_F(Service, SaysWhenItStops) {
  {
    const ServiceManager manager;
  }
  EXPECT_EQ(heard(), "STOPPING=1\n");
}

TEST_F(Service, MissingServiceManagerIsIgnored) {
  std::filesystem::remove(path_);
  for (const char* path : {path_.c_str(), "", "/none/such", "@tact-none"}) {
    setenv("NOTIFY_SOCKET", path, 1);
    ServiceManager manager;
    manager.report({.may_be_armed = true});
  }
  EXPECT_EQ(heard(), "");
  unsetenv("NOTIFY_SOCKET");
  EXPECT_FALSE(is_service());
}

}  // namespace tact::firmware::console::service_manager_test
