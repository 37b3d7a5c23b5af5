// SPDX-License-Identifier: Apache-2.0
// ros_bridge.h - from the tick log to the topics, and from servo_cp to the simulated hand; what is
// well, and what is not, as diagnostics.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "firmware/protocol/logged_tick.h"
#include "firmware/protocol/run_header.h"
#include "host/ros/growing_log.h"
#include "host/ros/ros_topics.h"
#include "host/ros/servo_hand.h"

namespace tact::host::ros {

class RosBridge {
 public:
  RosBridge(const std::string& log, RosTopics topics, bool servo);

  /// Call when the log has grown, and ten times a second. An error ends the program.
  std::optional<model::Error> work();

 private:
  using Clock = std::chrono::steady_clock;
  void begin(const firmware::protocol::RunHeader& run);
  void add(const firmware::protocol::LoggedTick& tick);
  void take_servo();
  void report(Clock::time_point now);
  Diagnostic diagnostic(Clock::time_point now) const;

  RosTopics topics_;
  GrowingLog log_;
  ServoHand hand_;
  bool servo_;
  std::string device_, scene_;
  firmware::protocol::LoggedTick newest_;
  std::uint64_t ticks_ = 0, missed_ = 0, refused_before_ = 0;
  Clock::time_point came_{}, reported_{};
  Diagnostic last_;
};

}  // namespace tact::host::ros
