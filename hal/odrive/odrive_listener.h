// SPDX-License-Identifier: Apache-2.0
// odrive_listener.h - what three ODrives have said so far, while they are set up.
//
// Zero torque goes to all three every 5 ms, so a watchdog that a run before has left behind stays
// fed. Set-up code: blocks.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "hal/can/can_bus.h"
#include "hal/odrive/odrive_delta.h"
#include "hal/odrive/odrive_errors.h"
#include "model/result.h"

namespace tact::hal::odrive {

OdriveTorqueLength odrive_torque_length(const OdriveSettings& settings);

/// One axis, as its frames report it.
struct OdriveHeard {
  int node = 0;
  int heartbeats = 0;
  std::int64_t beat_ns = 0, longest_beat_ns = 0;  // when the last one came; between two, so far
  std::uint32_t error = 0, parts = 0;
  std::uint8_t state = 0, result = 0;
  bool searched = false;  // for its index pulse
  std::optional<OdriveVersion> version{};
  std::optional<std::int32_t> shadow_count{};  // 0.5
  int positions = 0;
  bool all_zero = true;  // of these: position and velocity, to the bit
  double at_turns = 0.0, least_turns = 0.0, most_turns = 0.0;

  bool is_in(OdriveAxisState one) const { return state == static_cast<std::uint8_t>(one); }
  double moved_turns() const { return most_turns - least_turns; }
  void forget_positions() { positions = 0, all_zero = true; }
};

class OdriveListener {
 public:
  using Condition = std::function<bool(const OdriveHeard&)>;

  OdriveListener(can::CanBus& bus, const model::DeviceSettings& settings);

  std::array<OdriveHeard, 3> axes;
  OdriveGeneration generation = OdriveGeneration::k05;

  /// The same message to all three; `message` makes it for a node.
  template <class Message>
  void each(const Message& message) {
    for (const OdriveHeard& axis : axes) bus_.push(message(axis.node));
    bus_.send();
  }
  void report(const std::optional<can::CanFrame>& frame) {
    bus_.push(frame);
    bus_.send();
  }
  void forget_heartbeats() {
    for (OdriveHeard& axis : axes) axis.heartbeats = 0;
  }
  void forget_positions() {
    for (OdriveHeard& axis : axes) axis.forget_positions();
  }

  /// Feeds and listens until all three fit: true, or the time is over or the bus broke: false.
  bool run_until(const Condition& fits, int time_ms);
  void run_for(int time_ms) {
    run_until([](const OdriveHeard&) { return false; }, time_ms);
  }
  /// The first axis that fits, as a message.
  std::optional<model::Error> wrong(const Condition& fits, const char* words) const;

 private:
  void take(const can::CanFrame& frame, std::int64_t arrival_ns);
  void take_heartbeat(OdriveHeard& axis, const can::CanFrame& frame, const OdriveHeartbeat& beat);

  can::CanBus& bus_;
  const can::CanSettings& can_;
  OdriveTorqueLength torque_length_;
  std::int64_t feed_ns_ = 0;
};

}  // namespace tact::hal::odrive
