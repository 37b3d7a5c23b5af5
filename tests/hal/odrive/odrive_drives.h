// SPDX-License-Identifier: Apache-2.0
// odrive_drives.h - three ODrives on the scripted bus: what they say each millisecond, and what
// they heard. They know the protocol by the decoders that the vectors prove.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "hal/can/little_endian.h"
#include "hal/odrive/odrive_protocol.h"
#include "tests/support/can_drives.h"

namespace tact::tests {

struct PlayedOdrive {
  int node = 0;
  bool powered = true;  // on the bus at all
  bool says_position = true;
  bool says_heartbeat = true;
  bool obeys = true;         // goes where Set_Axis_State says
  bool stuck_error = false;  // Clear_Errors does not help
  bool no_supply = false;    // of its motor
  bool v06 = true;
  int position_every_ms = 1, heartbeat_every_ms = 100;
  std::uint32_t error = 0;
  std::uint32_t state = 1;
  std::uint8_t parts = 0;               // byte 6 of the heartbeat of 0.5: the encoder's error
  int index_ms = 400, searched_ms = 0;  // a search, after which the pulse is at 0.1 turns
  double turns = 0.0, turns_per_s = 0.0;
  std::uint32_t control = 0, input = 0;
  float limit_turns_per_s = 0.0f, limit_A = 0.0f;
  float torque_Nm = 0.0f;
  std::vector<hal::odrive::OdriveCommand> heard;
};

class PlayedOdrives {
 public:
  PlayedOdrives() : bus([this] { millisecond(); }) {
    for (int i = 0; i < 3; ++i) axis[static_cast<std::size_t>(i)].node = i + 1;
  }

  /// Hears the host, moves on by 1 ms, says what is due.
  void millisecond() {
    listen();
    ++time_ms;
    for (PlayedOdrive& one : axis) {
      if (!one.powered) continue;
      one.turns += 1e-3 * one.turns_per_s;
      if (one.state == 6 && ++one.searched_ms > one.index_ms) one.state = 1, one.turns = 0.1;
      if (one.says_heartbeat && (time_ms + 7 * one.node) % one.heartbeat_every_ms == 0)
        say_heartbeat(one);
      if (one.says_position && time_ms % one.position_every_ms == 0) say_position(one);
    }
  }
  void say_heartbeat(const PlayedOdrive& one) {
    auto frame = message(one, hal::odrive::OdriveCommand::kHeartbeat);
    hal::can::put_unsigned(frame.data, 0, 4, one.error);
    frame.data[4] = static_cast<std::uint8_t>(one.state);
    if (!one.v06) frame.data[6] = one.parts;
    bus.say(frame);
  }
  void say_position(const PlayedOdrive& one) {
    auto frame = message(one, hal::odrive::OdriveCommand::kGetEncoderEstimates);
    hal::can::put_f32(frame.data, 0, static_cast<float>(one.turns));
    hal::can::put_f32(frame.data, 4, static_cast<float>(one.turns_per_s));
    bus.say(frame);
  }
  void listen() {
    for (const hal::can::CanFrame& frame : bus.hear_all()) {
      const auto to = hal::odrive::odrive_address(frame);
      for (PlayedOdrive& one : axis)
        if (one.node == to.node && one.powered) obey(one, to.command, frame);
    }
  }
  void forget() {
    for (PlayedOdrive& one : axis) one.heard.clear();
  }
  int times(std::size_t i, hal::odrive::OdriveCommand command) const {
    return static_cast<int>(std::count(axis[i].heard.begin(), axis[i].heard.end(), command));
  }

  std::array<PlayedOdrive, 3> axis;
  int time_ms = 0;
  ScriptedBus bus;

 private:
  static hal::can::CanFrame message(const PlayedOdrive& one, hal::odrive::OdriveCommand command) {
    return hal::can::make_can_frame(
        static_cast<std::uint32_t>(one.node) << 5 | static_cast<std::uint32_t>(command), 8);
  }
  void obey(PlayedOdrive& one, hal::odrive::OdriveCommand command,
            const hal::can::CanFrame& frame) {
    using enum hal::odrive::OdriveCommand;
    one.heard.push_back(command);
    if (command == kSetInputTorque) one.torque_Nm = hal::can::get_f32(frame.data, 0);
    if (command == kClearErrors && !one.stuck_error) one.error = 0;
    if (command == kEstop) one.error |= 0x2000000, one.state = 1;
    if (command == kSetAxisState && one.obeys) one.state = hal::can::get_u32(frame.data, 0);
    if (one.state == 8 && one.no_supply) one.error |= one.v06 ? 0x200u : 0x2u, one.state = 1;
    if (command == kSetControllerMode) {
      one.control = hal::can::get_u32(frame.data, 0);
      one.input = hal::can::get_u32(frame.data, 4);
    }
    if (command == kSetLimits) {
      one.limit_turns_per_s = hal::can::get_f32(frame.data, 0);
      one.limit_A = hal::can::get_f32(frame.data, 4);
    }
    if (command == kGetEncoderCount05 && frame.rtr && !one.v06) {
      auto reply = message(one, kGetEncoderCount05);
      const auto counts = static_cast<std::int32_t>(one.turns * 8192.0);
      hal::can::put_unsigned(reply.data, 0, 4, static_cast<std::uint32_t>(counts));
      bus.say(reply);
    }
    if (command == kGetVersion && frame.rtr && one.v06) {
      auto reply = message(one, kGetVersion);
      reply.data = {2, 4, 4, 58, 0, 6, 10, 0};
      bus.say(reply);
    }
  }
};

}  // namespace tact::tests
