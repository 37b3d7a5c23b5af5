// SPDX-License-Identifier: Apache-2.0
// tact-ros: each tick of tactd as topics of ROS 2, and servo_cp for the simulated hand.
#include <fmt/format.h>
#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <regex>

#include "host/ros/ros_bridge.h"
#include "model/io/program/command_line.h"
#include "model/io/program/program_end.h"
#include "model/io/program/within.h"

namespace tact::host::ros {
namespace {

constexpr int kGood = 0, kBadInput = 2;
constexpr int kMaxDomain = 232;  // of DDS: the ports end there
constexpr int kTurn_ms = 100;

int fail(const std::string& message) {
  fmt::print(stderr, "tact-ros: {}\n", message);
  return kBadInput;
}

volatile std::sig_atomic_t stopped = 0;

/// Works when something in the folder of the log changes, and each kTurn_ms.
int run(const std::filesystem::path& log, const RosOptions& options) {
  RosBridge bridge(log);
  if (const auto error = bridge.open(options)) return fail(error->message);
  const std::string folder = log.has_parent_path() ? log.parent_path().string() : ".";
  pollfd change{.fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC), .events = POLLIN, .revents = 0};
  if (inotify_add_watch(change.fd, folder.c_str(), IN_MODIFY | IN_CREATE | IN_MOVED_TO) < 0)
    return fail(fmt::format("{}: {}; name a file in a folder that can be read", folder,
                            std::strerror(errno)));
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, [](int) { stopped = 1; });
  while (stopped == 0) {
    if (const auto error = bridge.work()) return fail(error->message);
    char changes[4096];
    if (poll(&change, 1, kTurn_ms) == 1 && ::read(change.fd, changes, sizeof changes) < 0) break;
  }
  return kGood;
}

/// As ROS wants a namespace.
std::string check_name(const std::string& word) {
  static const std::regex kName("[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*");
  return std::regex_match(word, kName) ? "" : word + " is no name of ROS";
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
  app.add_option("--domain", options.domain, "of DDS (default: ROS_DOMAIN_ID, else 0)")
      ->envname("ROS_DOMAIN_ID")
      ->check(model::io::within(0, kMaxDomain));
  app.add_option("--namespace", options.name_space, "before each topic; also of the frame")
      ->capture_default_str()
      ->check(check_name);
  app.add_option("--interface", options.interface,
                 "of the network, as eth0: everyone there may read, and move with --servo "
                 "(default: loopback alone)");
  app.add_flag("--servo", options.servo,
               "let servo_cp move the hand of a simulated device; a real device is never moved");
  return model::io::parse_command_line(app, "tact-ros", argc, argv);
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
