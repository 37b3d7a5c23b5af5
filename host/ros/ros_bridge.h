// SPDX-License-Identifier: Apache-2.0
// ros_bridge.h - from the tick log to the topics, from servo_cp to the hand of a simulated device
// (never to a real one, and never a force), and what is well or not as diagnostics.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "host/ros/growing_log.h"
#include "host/ros/ros_topics.h"

namespace tact::host::ros {

class RosBridge {
 public:
  explicit RosBridge(const std::string& log);
  ~RosBridge();
  RosBridge(const RosBridge&) = delete;
  RosBridge& operator=(const RosBridge&) = delete;

  std::optional<model::Error> open(const RosOptions& options) { return topics_.open(options); }
  /// Call when the log has grown, and ten times a second. An error ends the program.
  std::optional<model::Error> work();

 private:
  using Clock = std::chrono::steady_clock;
  void begin(const firmware::protocol::RunHeader& run);
  void add(const firmware::protocol::LoggedTick& tick);
  /// Empty, or why the pose is refused as a whole.
  std::string move(const ServoPose& pose) const;
  void report(const Diagnostic& now);
  Diagnostic diagnostic() const;

  RosTopics topics_;
  GrowingLog log_;
  int hand_;  // a socket
  firmware::protocol::RunHeader run_;
  firmware::protocol::LoggedTick newest_;
  std::uint64_t ticks_ = 0, missed_ = 0, moved_ = 0, refused_ = 0, reported_refused_ = 0;
  std::string why_, reported_message_;  // of the newest pose that was refused; of report()
  Clock::time_point came_{}, reported_{};
};

}  // namespace tact::host::ros
