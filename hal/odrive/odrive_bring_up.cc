// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_bring_up.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "hal/can/can_delta.h"

namespace tact::hal::odrive {
namespace {

using model::Error;
using model::Result;

constexpr int kHeartbeatWait_ms = 1000, kVersionWait_ms = 300, kIdleWait_ms = 1000;
constexpr int kFeed_ms = 5, kPositions_ms = 200, kIndexSearch_ms = 20'000, kIndexStart_ms = 300;
constexpr double kRest_turns = 0.02;  // of a motor while the positions are counted
constexpr double kMostRate_Hz = 1000.0;

struct Axis {
  int node = 0;
  int heartbeats = 0;
  std::uint32_t error = 0, parts = 0;
  std::uint8_t state = 0, result = 0;
  bool searched = false;  // for its index pulse
  bool has_version = false;
  OdriveVersion version{};
  int positions = 0;
  double turns = 0.0, least_turns = 0.0, most_turns = 0.0;
};

class BringUp {
 public:
  BringUp(can::CanBus& bus, const model::CanSettings& can, double rate_Hz)
      : bus_(bus), can_(can), rate_Hz_(rate_Hz) {
    for (std::size_t i = 0; i < 3; ++i) axes_[i].node = can.node[i];
  }

  Result<OdriveStart> run() {
    using Step = std::optional<Error> (BringUp::*)();
    for (const Step step :
         {&BringUp::hear_all, &BringUp::find_generation, &BringUp::clear_errors,
          &BringUp::set_torque_mode, &BringUp::find_index, &BringUp::count_positions}) {
      if (auto error = (this->*step)()) return *error;
      if (bus_.fault() != Fault::kNone) return Error{can_bus_trouble(bus_.cause(), can_.interface)};
    }
    OdriveStart start{.generation = generation_, .motor_turns = {}};
    for (std::size_t i = 0; i < 3; ++i) start.motor_turns[i] = axes_[i].turns;
    return start;
  }

 private:
  using Condition = std::function<bool(const Axis&)>;

  std::optional<Error> hear_all() {
    if (run_until([](const Axis& a) { return a.heartbeats > 0; }, kHeartbeatWait_ms)) return {};
    const auto unheard = [](const Axis& a) { return a.heartbeats == 0; };
    if (std::all_of(axes_.begin(), axes_.end(), unheard))
      return Error{silent_bus_trouble(bus_, can_.interface)};
    return wrong([&](const Axis& a) { return unheard(a); },
                 "sends no heartbeat: is it on, and does it have this node?");
  }

  std::optional<Error> find_generation() {
    each([](int node) { return odrive_axis_state(node, OdriveAxisState::kIdle); });
    each([](int node) { return odrive_request(node, OdriveCommand::kGetVersion); });
    const auto answered = [](const Axis& a) { return a.has_version; };
    const bool all = run_until(answered, kVersionWait_ms);
    generation_ = all ? OdriveGeneration::k06 : OdriveGeneration::k05;
    if (!all && std::any_of(axes_.begin(), axes_.end(), answered)) {
      return wrong([&](const Axis& a) { return !answered(a); },
                   "does not tell its version while another drive does: give all three the same "
                   "firmware, 0.5.x or 0.6.x");
    }
    return wrong(
        [&](const Axis& a) {
          return a.has_version && (a.version.firmware_major != 0 || a.version.firmware_minor != 6);
        },
        "has a firmware that is neither 0.5.x nor 0.6.x: install one of these");
  }

  std::optional<Error> clear_errors() {
    each([](int node) { return odrive_clear_errors(node, false); });
    forget_heartbeats();
    // The first heartbeat may have been on its way; the second one tells.
    const auto told = [](const Axis& a) { return a.heartbeats > 1; };
    if (!run_until(told, kIdleWait_ms)) {
      return wrong([&](const Axis& a) { return !told(a); },
                   "stopped sending its heartbeat: check its supply and the CAN cable");
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const auto words = odrive_error_sentence(generation_, axes_[i].error, axes_[i].parts);
      if (!words.empty()) return Error{fmt::format("{}: {}", can::can_arm_name(i, can_), words)};
    }
    return wrong(
        [](const Axis& a) { return a.state != static_cast<std::uint8_t>(OdriveAxisState::kIdle); },
        "does not go idle: end the program that drives it, then start tactd again");
  }

  std::optional<Error> set_torque_mode() {
    each([](int node) {
      return odrive_controller_mode(node, OdriveControlMode::kTorque,
                                    OdriveInputMode::kPassThrough);
    });
    const bool limited = can_.max_velocity_turns_per_s > 0.0 && can_.max_current_A > 0.0;
    if (!limited) return {};  // the drive's own limits stay
    each([this](int node) {
      return odrive_limits(node, can_.max_velocity_turns_per_s, can_.max_current_A);
    });
    return {};
  }

  std::optional<Error> find_index() {
    if (can_.homing != model::Homing::kIndex) return {};
    for (Axis& axis : axes_) axis.positions = 0;
    each([](int node) { return odrive_axis_state(node, OdriveAxisState::kIndexSearch); });
    run_for(kIndexStart_ms);  // a heartbeat from before must not say that it is done
    forget_heartbeats();
    const auto done = [this](const Axis& a) {
      const bool searched = a.searched || a.most_turns - a.least_turns > kRest_turns;
      const bool good = generation_ == OdriveGeneration::k05 || a.result == 0;
      return a.heartbeats > 0 && searched && good && a.error == 0 && a.parts == 0 &&
             a.state == static_cast<std::uint8_t>(OdriveAxisState::kIdle);
    };
    if (run_until(done, kIndexSearch_ms)) return {};
    each([](int node) { return odrive_axis_state(node, OdriveAxisState::kIdle); });
    return wrong([&](const Axis& a) { return !done(a); },
                 "does not find its index pulse: let the arm move freely and check the encoder's "
                 "index wire");
  }

  std::optional<Error> count_positions() {
    for (Axis& axis : axes_) axis.positions = 0;
    run_for(kPositions_ms);
    for (std::size_t i = 0; i < 3; ++i) {
      const Axis& a = axes_[i];
      if (a.positions == 0 || a.positions < 0.8e-3 * kPositions_ms * rate_Hz_) {
        return Error{fmt::format(
            "{} sends its position {:.0f} times a second, not {:.0f} times: set {} = 1 in "
            "odrivetool, save, restart the drive",
            can::can_arm_name(i, can_), a.positions * 1e3 / kPositions_ms, rate_Hz_,
            generation_ == OdriveGeneration::k06 ? "axis.config.can.encoder_msg_rate_ms"
                                                 : "axis.config.can.encoder_rate_ms")};
      }
    }
    if (can_.homing != model::Homing::kJig) return {};
    return wrong([](const Axis& a) { return a.most_turns - a.least_turns > kRest_turns; },
                 "moves: let the arms rest on the jig until tactd is ready");
  }

  /// The first axis that fits, as a sentence.
  std::optional<Error> wrong(const Condition& fits, const char* words) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (fits(axes_[i])) return Error{fmt::format("{} {}", can::can_arm_name(i, can_), words)};
    return {};
  }

  template <class Message>
  void each(const Message& message) {
    for (const Axis& axis : axes_) bus_.push(message(axis.node));
    bus_.send();
  }

  void forget_heartbeats() {
    for (Axis& axis : axes_) axis.heartbeats = 0;
  }

  void run_for(int time_ms) {
    run_until([](const Axis&) { return false; }, time_ms);
  }

  /// Feeds and listens until all three fit: true, or the time is over or the bus broke: false.
  bool run_until(const Condition& fits, int time_ms) {
    can::CanSocket& socket = bus_.socket();
    const std::int64_t end_ns = socket.now_ns() + time_ms * 1'000'000LL;
    while (bus_.fault() == Fault::kNone) {
      for (const can::CanReceived& one : bus_.receive()) take(one.frame);
      if (std::all_of(axes_.begin(), axes_.end(), fits)) return true;
      const std::int64_t now_ns = socket.now_ns();
      if (now_ns >= end_ns) return false;
      if (now_ns >= feed_ns_) {
        feed_ns_ = now_ns + kFeed_ms * 1'000'000LL;
        each([this](int node) {
          return odrive_input_torque(node, 0.0, odrive_torque_length(can_));
        });
      }
      socket.wait(kFeed_ms);
    }
    return false;
  }

  void take(const can::CanFrame& frame) {
    for (Axis& axis : axes_) {
      if (const auto beat = decode_odrive_heartbeat(frame, axis.node)) {
        ++axis.heartbeats;
        axis.error = beat->axis_error;
        axis.state = beat->axis_state;
        axis.result = beat->procedure_result;
        axis.searched =
            axis.searched || axis.state == static_cast<std::uint8_t>(OdriveAxisState::kIndexSearch);
        const auto beat05 = decode_odrive_heartbeat_05(frame, axis.node);
        axis.parts = generation_ == OdriveGeneration::k05 && beat05 ? odrive_parts_05(*beat05) : 0;
      } else if (const auto version = decode_odrive_version(frame, axis.node)) {
        axis.has_version = true;
        axis.version = *version;
      } else if (const auto at = decode_odrive_estimates(frame, axis.node)) {
        const bool first = axis.positions++ == 0;
        axis.turns = at->position_turns;
        axis.least_turns = first ? axis.turns : std::min(axis.least_turns, axis.turns);
        axis.most_turns = first ? axis.turns : std::max(axis.most_turns, axis.turns);
      }
    }
  }

  can::CanBus& bus_;
  const model::CanSettings& can_;
  double rate_Hz_;
  std::array<Axis, 3> axes_;
  OdriveGeneration generation_ = OdriveGeneration::k05;
  std::int64_t feed_ns_ = 0;
};

}  // namespace

std::vector<std::uint32_t> odrive_ids(const model::CanSettings& can) {
  std::vector<std::uint32_t> ids;
  for (const int node : can.node) {
    for (const OdriveCommand one : {OdriveCommand::kGetVersion, OdriveCommand::kHeartbeat,
                                    OdriveCommand::kGetEncoderEstimates}) {
      ids.push_back(static_cast<std::uint32_t>(node) << 5 | static_cast<std::uint32_t>(one));
    }
  }
  return ids;
}

OdriveTorqueLength odrive_torque_length(const model::CanSettings& can) {
  return can.short_torque ? OdriveTorqueLength::kShort : OdriveTorqueLength::kPadded;
}

int odrive_cycle_bits(const model::CanSettings& can) {
  const auto length = static_cast<std::uint8_t>(odrive_torque_length(can));
  const int torque = can_bits_on_bus(can::make_can_frame(0, length)).most;
  return 3 * (torque + can_bits_on_bus(can::make_can_frame(0, 8)).most);
}

Result<OdriveStart> bring_up_odrives(can::CanBus& bus, const model::CanSettings& can,
                                     double rate_Hz) {
  for (const int node : can.node) {
    if (node <= kOdriveLargestNode) continue;
    return Error{fmt::format("device.can.node has {}, but an ODrive's node is 0 to {}", node,
                             kOdriveLargestNode)};
  }
  if (!(rate_Hz <= kMostRate_Hz)) {
    return Error{fmt::format(
        "rate_Hz is {}, but three drives on one CAN bus tell their positions {} times a second",
        rate_Hz, kMostRate_Hz)};
  }
  return BringUp(bus, can, rate_Hz).run();
}

}  // namespace tact::hal::odrive
