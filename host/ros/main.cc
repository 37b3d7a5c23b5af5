// SPDX-License-Identifier: Apache-2.0
// tact-ros: each tick of tactd as topics of ROS 2, and servo_cp for the simulated hand.
#include <fmt/format.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "host/net/stop_signals.h"
#include "host/ros/ros_bridge.h"
#include "model/io/program/command_line.h"
#include "model/io/program/program_end.h"
#include "model/io/program/within.h"

namespace tact::host::ros {
namespace {

constexpr int kGood = 0, kBadInput = 2;
constexpr int kMaxDomain = 232;  // of DDS: the ports end there
constexpr std::chrono::milliseconds kTurn{100};

int fail(const std::string& message) {
  fmt::print(stderr, "tact-ros: {}\n", message);
  return kBadInput;
}

/// Works when something in the folder of the log changes, and each kTurn.
class Turns {
 public:
  Turns(boost::asio::io_context& io, RosBridge& bridge)
      : io_(io), timer_(io), folder_(io), bridge_(bridge) {}

  std::optional<model::Error> start(const std::filesystem::path& log) {
    const std::string folder = log.has_parent_path() ? log.parent_path().string() : ".";
    const int fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (fd >= 0) folder_.assign(fd);
    if (fd < 0 || inotify_add_watch(fd, folder.c_str(), IN_MODIFY | IN_CREATE | IN_MOVED_TO) < 0)
      return model::Error{fmt::format("{}: {}; name a file in a folder that can be read", folder,
                                      std::strerror(errno))};
    wait_for_change();
    wait_for_turn();
    return std::nullopt;
  }
  std::optional<model::Error> error;

 private:
  void work() {
    error = bridge_.work();
    if (error) io_.stop();
  }
  void wait_for_change() {
    folder_.async_read_some(boost::asio::buffer(changes_),
                            [this](boost::system::error_code wrong, std::size_t) {
                              if (wrong) return;
                              work();
                              wait_for_change();
                            });
  }
  void wait_for_turn() {
    timer_.expires_after(kTurn);
    timer_.async_wait([this](boost::system::error_code wrong) {
      if (wrong) return;
      work();
      wait_for_turn();
    });
  }

  boost::asio::io_context& io_;
  boost::asio::steady_timer timer_;
  boost::asio::posix::stream_descriptor folder_;
  RosBridge& bridge_;
  std::array<char, 4096> changes_{};
};

int run(const std::string& log, const RosOptions& options) {
  auto topics = RosTopics::open(options);
  if (!topics) return fail(topics.error().message);
  RosBridge bridge(log, std::move(*topics), options.servo);
  boost::asio::io_context io(1);
  net::StopSignals signals(io);
  if (const auto wrong = signals.wait([&io] { io.stop(); }))
    return fail("Ctrl-C cannot be waited for: " + wrong.message());
  Turns turns(io, bridge);
  if (const auto error = turns.start(log)) return fail(error->message);
  io.run();
  return turns.error ? fail(turns.error->message) : kGood;
}

/// As ROS wants a namespace: letters, digits, _ and / between them.
CLI::Validator ros_name() {
  return {[](std::string& word) {
            bool begins = true;
            for (const char c : word) {
              const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
              const bool digit = c >= '0' && c <= '9';
              if (!(letter || (!begins && (digit || c == '/')))) return word + " is no name of ROS";
              begins = c == '/';
            }
            return begins ? word + " is no name of ROS" : std::string();
          },
          "NAME"};
}

std::optional<int> parse_options(int argc, char** argv, std::string& log, RosOptions& options) {
  CLI::App app{
      "tact-ros: each tick of tactd as topics of ROS 2, without ROS 2 on this PC.\n"
      "tactd never waits for it. It cannot command a force. Ctrl-C ends it.\n\n"
      "example:\n"
      "  tactd model/scenes/liver.toml --record run.tactlog &\n"
      "  tact-ros run.tactlog --domain 0            # tact/measured_cp, _cv, _cf; diagnostics\n"
      "  ros2 topic echo /tact/measured_cp          # on this PC, where ROS 2 is\n\n"
      "Exit status: 0 ended by Ctrl-C or TERM, 2 bad usage or input."};
  app.add_option("LOG", log, "the file of tactd --record; waited for if it is not there yet")
      ->required();
  const char* id = std::getenv("ROS_DOMAIN_ID");
  options.domain = id != nullptr ? std::atoi(id) : 0;
  app.add_option("--domain", options.domain, "of DDS (default: ROS_DOMAIN_ID, else 0)")
      ->check(model::io::within(0, kMaxDomain));
  app.add_option("--namespace", options.name_space, "before each topic; also of the frame")
      ->capture_default_str()
      ->check(ros_name());
  app.add_option("--interface", options.interface,
                 "of the network, as eth0: everyone there may read, and move with --servo "
                 "(default: loopback alone)");
  app.add_flag("--servo", options.servo,
               "let servo_cp move the hand of a simulated device; a real device is never moved");
  if (const auto status = model::io::parse_command_line(app, "tact-ros", argc, argv))
    return status;
  if (options.domain < 0 || options.domain > kMaxDomain)
    return fail(fmt::format("ROS_DOMAIN_ID is {}: must be 0 to {}", id, kMaxDomain));
  return std::nullopt;
}

}  // namespace
}  // namespace tact::host::ros

int main(int argc, char** argv) {
  tact::model::io::watch_standard_output("tact-ros");
  tact::model::io::report_uncaught("tact-ros");
  try {
    std::string log;
    tact::host::ros::RosOptions options;
    if (const auto status = tact::host::ros::parse_options(argc, argv, log, options))
      return *status;
    return tact::host::ros::run(log, options);
  } catch (const std::exception& error) {  // by a library, without memory or descriptors
    std::fprintf(stderr, "tact-ros: %s\n", error.what());
    return 2;
  }
}
