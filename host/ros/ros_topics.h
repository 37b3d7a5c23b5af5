// SPDX-License-Identifier: Apache-2.0
// ros_topics.h - the topics of tact-ros over CycloneDDS: writes each tick, reads where the hand of
// a simulated device shall be.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware/protocol/logged_tick.h"
#include "model/result.h"

namespace tact::host::ros {

struct RosOptions {
  std::string name_space = "tact";  // before each topic
  int domain = 0;
  std::string interface;  // empty: loopback alone
  bool servo = false;     // read servo_cp
};

/// A pose as it came: nothing of it is checked.
struct ServoPose {
  std::string frame_id;
  double position_m[3];
  double orientation_wxyz[4];
};

/// sensor_msgs/JointState of three driven joints.
struct JointState {
  std::array<double, 3> angle_rad{}, rate_radps{};
};

/// Where ROS reads that all is well, or not: diagnostic_msgs/DiagnosticStatus.
struct Diagnostic {
  enum Level : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };
  Level level = kStale;
  std::string message;
  std::string device;
  std::vector<std::pair<std::string, std::string>> values;
};

class RosTopics {
 public:
  RosTopics() = default;
  RosTopics(const RosTopics&) = delete;
  RosTopics& operator=(const RosTopics&) = delete;
  ~RosTopics();
  std::optional<model::Error> open(const RosOptions& options);

  /// measured_cp, measured_cv, measured_cf of this tick.
  void write(const firmware::protocol::LoggedTick& tick);
  /// joint_states of this tick; the topic begins with the first.
  void write(const firmware::protocol::LoggedTick& tick, const JointState& joints);
  void write(const Diagnostic& diagnostic);
  /// All poses that have come on servo_cp, the newest last.
  void read_servo(const std::function<void(const ServoPose&)>& take);
  /// Frame W of tact, as ROS knows it.
  const std::string& frame() const { return frame_; }

 private:
  bool make(bool servo);

  std::string frame_, name_;
  std::int32_t domain_ = 0, participant_ = 0, pose_ = 0, twist_ = 0, wrench_ = 0, diagnostics_ = 0,
               servo_ = 0, joints_ = 0;
};

}  // namespace tact::host::ros
