// SPDX-License-Identifier: Apache-2.0
// cia402_drives.h - three CiA 402 drives on the scripted bus: settings, states, SYNC, heartbeats.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "hal/can/little_endian.h"
#include "hal/cia402/canopen_frames.h"
#include "hal/cia402/cia402_state.h"
#include "tests/support/can_drives.h"

namespace tact::tests {

struct PlayedCia402 {
  int node = 0;
  bool powered = true;
  bool says_heartbeat = true, says_sample = true, obeys = true, follows = true;
  bool starts = true;  // becomes operational
  int resets = 0;      // of its communication
  std::uint32_t device_type = 0x00020192, modes = 1u << 9;
  std::uint32_t rated = 500;  // torque, 0.001 N m
  std::uint32_t refused = 0;  // index << 8 | sub that is answered by `abort_code`
  std::uint32_t abort_code = 0;
  std::vector<std::uint32_t> read_only{};  // indices << 8 | sub: writing is refused
  bool stuck_fault = false;
  std::uint16_t error_code = 0;
  std::uint16_t status = 0x40;  // switch-on disabled
  hal::cia402::NmtState nmt = hal::cia402::NmtState::kBoot;
  double turns = 0.0, turns_per_s = 0.0;
  std::uint16_t controlword = 0;
  std::int16_t permille = 0;                       // commanded
  std::int16_t extra_permille = 0;                 // that nothing commanded
  std::vector<std::uint16_t> controlwords;         // every change
  std::map<std::uint32_t, std::uint32_t> written;  // index << 8 | sub
  int fault_resets = 0;
  bool answers_watch = true, refuses_watch = false;  // to a change of 1016 while operational
  int host_heard_ms = -1;                            // -1: not since 1016 was written
};

class PlayedCia402s {
 public:
  PlayedCia402s() : bus([this] { millisecond(); }) {
    for (int i = 0; i < 3; ++i) axis[static_cast<std::size_t>(i)].node = i + 1;
  }

  void millisecond() {
    listen();
    ++time_ms;
    for (PlayedCia402& one : axis) {
      one.turns += 1e-3 * one.turns_per_s;
      miss_host(one);
      const int every_ms = static_cast<int>(one.written[0x101700]);
      if (one.powered && one.says_heartbeat && every_ms > 0 && time_ms % every_ms == 0)
        say_heartbeat(one);
    }
  }
  void say_heartbeat(const PlayedCia402& one) {
    bus.say(*hal::cia402::canopen_heartbeat(one.node, one.nmt));
  }
  void say_sample(const PlayedCia402& one) {
    auto frame = hal::can::make_can_frame(0x180u + static_cast<std::uint32_t>(one.node), 8);
    const bool enabled = one.status == 0x27;
    hal::can::put_unsigned(frame.data, 0, 2, one.status | (enabled && one.follows ? 0x1000u : 0u));
    hal::can::put_unsigned(frame.data, 2, 4, counts(one));
    const int permille = enabled ? one.permille + one.extra_permille : 0;
    hal::can::put_unsigned(frame.data, 6, 2, static_cast<std::uint16_t>(permille));
    bus.say(frame);
  }
  void say_emergency(const PlayedCia402& one, std::uint16_t code) {
    auto frame = hal::can::make_can_frame(0x080u + static_cast<std::uint32_t>(one.node), 8);
    hal::can::put_unsigned(frame.data, 0, 2, code);
    bus.say(frame);
  }
  void listen() {
    for (const hal::can::CanFrame& frame : bus.hear_all()) {
      heard.push_back(frame);
      for (PlayedCia402& one : axis)
        if (one.powered) take(one, frame);
      if (frame.id != 0x77F) continue;
      ++host_heartbeats;
      for (PlayedCia402& one : axis) one.host_heard_ms = time_ms;
    }
  }
  void forget() { heard.clear(); }

  std::array<PlayedCia402, 3> axis;
  int time_ms = 0;
  int host_heartbeats = 0;
  std::vector<hal::can::CanFrame> heard;
  ScriptedBus bus;

 private:
  /// 1016: a heartbeat that came once has to come again within the time.
  void miss_host(PlayedCia402& one) {
    const auto timeout_ms = static_cast<int>(one.written[0x101601] & 0xFFFFu);
    if (timeout_ms == 0 || one.host_heard_ms < 0) return;
    if (time_ms - one.host_heard_ms <= timeout_ms) return;
    one.host_heard_ms = -1;
    one.status = 0x08;
    one.error_code = 0x8130;
    say_emergency(one, 0x8130);
  }
  static std::uint32_t counts(const PlayedCia402& one) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(one.turns * 10'000.0));
  }
  void take(PlayedCia402& one, const hal::can::CanFrame& frame) {
    const auto node = static_cast<std::uint32_t>(one.node);
    if (frame.id == 0x000 && frame.data[1] == one.node) take_nmt(one, frame.data[0]);
    if (frame.id == 0x600 + node) answer(one, frame);
    if (frame.id == 0x200 + node && one.nmt == hal::cia402::NmtState::kOperational) {
      command(one, hal::can::get_u16(frame.data, 0));
      one.permille = hal::can::get_i16(frame.data, 2);
    }
    if (frame.id == 0x080 && one.nmt == hal::cia402::NmtState::kOperational && one.says_sample)
      say_sample(one);
  }
  void take_nmt(PlayedCia402& one, std::uint8_t code) {
    if (!one.obeys) return;
    if (code == 0x82) {
      ++one.resets;
      bus.say(*hal::cia402::canopen_heartbeat(one.node, hal::cia402::NmtState::kBoot));
    }
    if (code == 0x01 && one.starts) one.nmt = hal::cia402::NmtState::kOperational;
    if (code == 0x80) one.nmt = hal::cia402::NmtState::kPreOperational;
  }
  static void command(PlayedCia402& one, std::uint16_t word) {
    if (one.controlwords.empty() || one.controlwords.back() != word)
      one.controlwords.push_back(word);
    const bool edge = (word & 0x80) != 0 && (one.controlword & 0x80) == 0;
    one.controlword = word;
    if (edge) ++one.fault_resets;
    if (one.status == 0x08) {
      if (edge && !one.stuck_fault) one.status = 0x40;
      return;
    }
    if (!one.obeys) return;
    if (word == 0x06 && (one.status == 0x40 || one.status == 0x23)) one.status = 0x21;
    if (word == 0x07 && one.status == 0x21) one.status = 0x23;
    if (word == 0x0F && one.status == 0x23) one.status = 0x27;
    if (word == 0x02 || word == 0x00) one.status = 0x40;  // 605A = 0: a quick stop lets go
  }
  void answer(PlayedCia402& one, const hal::can::CanFrame& request) {
    const std::uint32_t entry =
        static_cast<std::uint32_t>(hal::can::get_u16(request.data, 1)) << 8 | request.data[3];
    auto reply = hal::can::make_can_frame(0x580u + static_cast<std::uint32_t>(one.node), 8);
    std::copy_n(request.data.begin() + 1, 3, reply.data.begin() + 1);
    const bool watch = entry == 0x101601 && one.nmt == hal::cia402::NmtState::kOperational;
    if (watch && !one.answers_watch) return;
    const bool constant = request.data[0] != 0x40 && std::ranges::count(one.read_only, entry) > 0;
    if (entry == one.refused || constant || (watch && one.refuses_watch)) {
      reply.data[0] = 0x80;
      hal::can::put_unsigned(reply.data, 4, 4, constant ? 0x06010002u : one.abort_code);
    } else if (request.data[0] == 0x40) {
      reply.data[0] = 0x43;
      hal::can::put_unsigned(reply.data, 4, 4, value(one, entry));
    } else {
      reply.data[0] = 0x60;
      one.written[entry] = hal::can::get_u32(request.data, 4);
      if (entry == 0x101601) one.host_heard_ms = -1;
      if (entry == 0x604000) command(one, hal::can::get_u16(request.data, 4));
    }
    bus.say(reply);
  }
  static std::uint32_t value(PlayedCia402& one, std::uint32_t entry) {
    switch (entry) {
      case 0x100000:
        return one.device_type;
      case 0x650200:
        return one.modes;
      case 0x604100:
        return one.status;
      case 0x603F00:
        return one.error_code;
      case 0x606400:
        return counts(one);
      case 0x607600:
        return one.rated;
      default:
        return one.written[entry];
    }
  }
};

}  // namespace tact::tests
