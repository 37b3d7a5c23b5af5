// SPDX-License-Identifier: Apache-2.0
// messages.h - what a tick or a frame says, as messages of ROS 2 (ros2msg, CDR).
//
// Vectors are along the axes of frame W, tact_device; force and torque are those on the hand at the
// tool's point. Doubles; a number that a frame does not have is NaN.
#pragma once

#include <cstdint>
#include <string>

#include "firmware/telemetry/telemetry_record.h"
#include "firmware/telemetry/tick_log.h"
#include "tools/mcap/mcap_writer.h"

namespace tact::tools::mcap {

const Schema& pose_schema();    // geometry_msgs/msg/PoseStamped
const Schema& wrench_schema();  // geometry_msgs/msg/WrenchStamped
const Schema& state_schema();   // tact_msgs/msg/State

struct Wrench {
  double force_N[3] = {};
  double torque_Nm[3] = {};
};

/// What goes into the four messages of one moment.
struct Moment {
  std::uint64_t time_ns = 0;  // of the stamps
  double position_m[3] = {};
  double rotation_wxyz[4] = {1.0, 0.0, 0.0, 0.0};
  Wrench written, wanted;
  std::uint64_t tick = 0;
  std::uint8_t state = 0, non_rt = 0;
  std::uint16_t fault = 0, limit = 0;
  double margin_us = 0.0;
  double grip_ratio = 0.0, rms_force_N = 0.0, given_energy_J = 0.0;
  std::uint64_t contact_losses = 0;

  static Moment of(const firmware::telemetry::LoggedTick& tick, std::uint64_t time_ns);
  static Moment of(const firmware::telemetry::Frame& frame, std::uint64_t time_ns);
};

std::string pose_message(const Moment& moment);
std::string wrench_message(const Moment& moment, const Wrench& wrench);
std::string state_message(const Moment& moment);

}  // namespace tact::tools::mcap
