// SPDX-License-Identifier: Apache-2.0
// servo_hand.h - moves the hand of a simulated device to a pose of servo_cp; never a real device,
// and never a force. A pose that is not good is refused as a whole.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/protocol/run_header.h"
#include "hal/sim/hand_target.h"
#include "host/ros/ros_topics.h"
#include "model/result.h"

namespace tact::host::ros {

/// The target of a good pose; else why it is refused.
model::Result<hal::sim::HandTarget> target_of(const ServoPose& pose, const std::string& frame,
                                              double grip_ratio);

class ServoHand {
 public:
  ServoHand();
  ~ServoHand();
  ServoHand(const ServoHand&) = delete;
  ServoHand& operator=(const ServoHand&) = delete;

  /// The device of this run. Of a real one, or of one in another user's folder, all are refused.
  void use(const firmware::protocol::RunHeader& run);
  void move(const ServoPose& pose, const std::string& frame, double grip_ratio);
  std::uint64_t moved() const { return moved_; }
  std::uint64_t refused() const { return refused_; }
  const std::string& why() const { return why_; }  // of the newest that was refused

 private:
  int socket_;
  std::string path_, closed_ = "no tactd is seen yet", why_;
  std::uint64_t moved_ = 0, refused_ = 0;
};

}  // namespace tact::host::ros
