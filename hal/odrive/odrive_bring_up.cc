// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_bring_up.h"

#include <fmt/core.h>

#include <algorithm>

#include "hal/can/can_delta.h"
#include "hal/odrive/odrive_listener.h"
#include "model/time_ns.h"

namespace tact::hal::odrive {
namespace {

using model::Error;
using model::Result;

constexpr int kHeartbeatWait_ms = 2500, kVersionWait_ms = 300, kIdleWait_ms = 2500;
constexpr int kPositions_ms = 200, kIndexSearch_ms = 20'000, kIndexStart_ms = 300;
constexpr int kAsleep_ms = 50, kCount_ms = 300, kWake_ms = 1500;
constexpr std::uint32_t kNeverEntered05 = 0x1 | 0x800;  // INVALID_STATE, the watchdog's
constexpr double kRest_turns = 0.02;  // of a motor while the positions are counted
constexpr double kMaxRate_Hz = 1000.0;

using Axis = OdriveHeard;

class BringUp {
 public:
  BringUp(can::CanBus& bus, const model::DeviceSettings& settings, double rate_Hz)
      : bus_(bus),
        can_(settings.of<can::CanSettings>()),
        own_(settings.of<OdriveSettings>()),
        rate_Hz_(rate_Hz),
        drives_(bus, settings) {}

  Result<OdriveStart> run() {
    using Step = std::optional<Error> (BringUp::*)();
    for (const Step step : {&BringUp::hear_all, &BringUp::find_generation, &BringUp::clear_errors,
                            &BringUp::set_torque_mode, &BringUp::find_index,
                            &BringUp::wake_estimates, &BringUp::count_positions}) {
      if (auto error = (this->*step)()) return *error;
      if (bus_.fault() != Fault::kNone)
        return Error{can::can_bus_fault_detail(bus_.cause(), can_.interface)};
    }
    OdriveStart start{.generation = drives_.generation, .motor_turns = {}};
    for (std::size_t i = 0; i < 3; ++i) start.motor_turns[i] = drives_.axes[i].at_turns;
    return start;
  }

 private:
  std::optional<Error> hear_all() {
    if (drives_.run_until([](const Axis& a) { return a.heartbeats > 0; }, kHeartbeatWait_ms))
      return {};
    const auto unheard = [](const Axis& a) { return a.heartbeats == 0; };
    if (std::all_of(drives_.axes.begin(), drives_.axes.end(), unheard))
      return Error{silent_bus_detail(bus_, can_.interface)};
    return drives_.wrong([&](const Axis& a) { return unheard(a); },
                         "sends no heartbeat: is it on, and does it have this node?");
  }

  std::optional<Error> find_generation() {
    drives_.each([](int node) { return odrive_axis_state(node, OdriveAxisState::kIdle); });
    drives_.each([](int node) { return odrive_request(node, OdriveCommand::kGetVersion); });
    const auto answered = [](const Axis& a) { return a.version.has_value(); };
    const bool all = drives_.run_until(answered, kVersionWait_ms);
    drives_.generation = all ? OdriveGeneration::k06 : OdriveGeneration::k05;
    if (!all && std::any_of(drives_.axes.begin(), drives_.axes.end(), answered)) {
      return drives_.wrong(
          [&](const Axis& a) { return !answered(a); },
          "does not report its version while another drive does: give all three the same "
          "firmware, 0.5.x or 0.6.x");
    }
    return drives_.wrong(
        [&](const Axis& a) {
          return a.version && (a.version->firmware_major != 0 || a.version->firmware_minor != 6);
        },
        "has a firmware that is neither 0.5.x nor 0.6.x: install one of these");
  }

  std::optional<Error> clear_errors() {
    drives_.each([](int node) { return odrive_clear_errors(node, false); });
    drives_.forget_heartbeats();
    // The first heartbeat may have been on its way; the second one counts.
    const auto reported = [](const Axis& a) { return a.heartbeats > 1; };
    const bool all_reported = drives_.run_until(reported, kIdleWait_ms);
    if (auto error = slow_heartbeat()) return error;
    if (!all_reported) {
      return drives_.wrong([&](const Axis& a) { return !reported(a); },
                           "stopped sending its heartbeat: check its supply and the CAN cable");
    }
    if (auto error = error_of_first()) return error;
    return drives_.wrong(
        [](const Axis& a) { return !a.is_in(OdriveAxisState::kIdle); },
        "does not go idle: end the program that drives it, then start tactd again");
  }

  /// Of one that the loop would take for silence.
  std::optional<Error> slow_heartbeat() const {
    for (std::size_t i = 0; i < 3; ++i) {
      const OdriveHeard& axis = drives_.axes[i];
      if (axis.longest_beat_ns <= kSlowestHeartbeat_ns) continue;
      return Error{
          fmt::format("{} sends its heartbeat every {} ms, and after {} ms without one it counts "
                      "as silent: set "
                      "axis.config.can.{} = 100 in odrivetool, save, restart the drive",
                      can::can_arm_name(i, can_), axis.longest_beat_ns / model::kMillisecond_ns,
                      kOdriveSilence_ns / model::kMillisecond_ns,
                      drives_.generation == OdriveGeneration::k06 ? "heartbeat_msg_rate_ms"
                                                                  : "heartbeat_rate_ms")};
    }
    return std::nullopt;
  }

  /// Of the first axis that reports one, in words.
  std::optional<Error> error_of_first() const {
    for (std::size_t i = 0; i < 3; ++i) {
      const OdriveHeard& axis = drives_.axes[i];
      const auto words = odrive_error_message(drives_.generation, axis.error, axis.parts);
      if (!words.empty()) return Error{fmt::format("{}: {}", can::can_arm_name(i, can_), words)};
    }
    return std::nullopt;
  }

  std::optional<Error> set_torque_mode() {
    drives_.each([](int node) {
      return odrive_controller_mode(node, OdriveControlMode::kTorque,
                                    OdriveInputMode::kPassThrough);
    });
    const bool limited = own_.max_velocity_turns_per_s > 0.0 && own_.max_current_A > 0.0;
    if (!limited) return {};  // the drive's own limits stay
    drives_.each([this](int node) {
      return odrive_limits(node, own_.max_velocity_turns_per_s, own_.max_current_A);
    });
    return {};
  }

  std::optional<Error> find_index() {
    if (can_.homing != can::Homing::kIndex) return {};
    drives_.forget_positions();
    drives_.each([](int node) { return odrive_axis_state(node, OdriveAxisState::kIndexSearch); });
    drives_.run_for(kIndexStart_ms);  // a heartbeat from before must not say that it is done
    drives_.forget_heartbeats();
    const auto done = [this](const Axis& a) {
      const bool searched = a.searched || a.moved_turns() > kRest_turns;
      const bool good = drives_.generation == OdriveGeneration::k05 || a.result == 0;
      return a.heartbeats > 0 && searched && good && a.error == 0 && a.parts == 0 &&
             a.is_in(OdriveAxisState::kIdle);
    };
    // One that refuses says so at once: it shall not search for the whole time.
    const auto refuses = [](const Axis& a) {
      return a.heartbeats > 0 && (a.error != 0 || a.parts != 0);
    };
    const bool ended =
        drives_.run_until([&](const Axis& a) { return done(a) || refuses(a); }, kIndexSearch_ms);
    if (ended && std::none_of(drives_.axes.begin(), drives_.axes.end(), refuses)) return {};
    drives_.each([](int node) { return odrive_axis_state(node, OdriveAxisState::kIdle); });
    if (auto error = error_of_first()) return error;
    return drives_.wrong(
        [&](const Axis& a) { return !done(a); },
        "does not find its index pulse: let the arm move freely and check the encoder's "
        "index wire");
  }

  /// An axis of 0.5 says position 0 and velocity 0, wherever it is, until it has entered closed
  /// loop once since power-on (OD-2). Each such axis alone enters it at zero torque.
  std::optional<Error> wake_estimates() {
    if (drives_.generation == OdriveGeneration::k06) return {};
    drives_.forget_positions();
    drives_.run_for(kAsleep_ms);
    bool woken = false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (drives_.axes[i].positions == 0 || !drives_.axes[i].all_zero) continue;
      if (auto error = wake(i)) return error;
      woken = true;
    }
    return woken ? clear_errors() : std::nullopt;
  }

  std::optional<Error> wake(std::size_t i) {
    Axis& axis = drives_.axes[i];
    const auto others = [&axis](const Axis& a) { return &a != &axis; };
    drives_.report(odrive_request(axis.node, OdriveCommand::kGetEncoderCount05));
    drives_.run_until([&](const Axis& a) { return others(a) || a.shadow_count; }, kCount_ms);
    // A motor without supply leaves closed loop at once, with an error: its estimates live on.
    const auto entered = [](const Axis& a) {
      const bool failed = (a.error & ~kNeverEntered05) != 0 || a.parts != 0;
      return a.heartbeats > 1 && (a.is_in(OdriveAxisState::kClosedLoop) || failed);
    };
    const auto awake = [&](const Axis& a) {
      const bool at_zero = a.shadow_count && *a.shadow_count == 0;
      return a.positions > 0 && (!a.all_zero || (at_zero && entered(a)));
    };
    axis.heartbeats = 0;
    axis.forget_positions();
    drives_.report(odrive_axis_state(axis.node, OdriveAxisState::kClosedLoop));
    const bool good =
        drives_.run_until([&](const Axis& a) { return others(a) || awake(a); }, kWake_ms);
    drives_.report(odrive_axis_state(axis.node, OdriveAxisState::kIdle));
    if (good) return {};
    const auto words = odrive_error_message(OdriveGeneration::k05, axis.error, axis.parts);
    return Error{fmt::format(
        "{} reports position 0 while its encoder counts {}: firmware 0.5 reports its position only "
        "after it has entered closed loop once, and it does not: {}",
        can::can_arm_name(i, can_),
        axis.shadow_count ? fmt::format("{}", *axis.shadow_count) : std::string("unknown"),
        words.empty() ? "calibrate it with odrivetool (axis.requested_state), then save" : words)};
  }

  std::optional<Error> count_positions() {
    drives_.forget_positions();
    drives_.run_for(kPositions_ms);
    for (std::size_t i = 0; i < 3; ++i) {
      const Axis& a = drives_.axes[i];
      if (a.positions == 0 || a.positions < 0.8e-3 * kPositions_ms * rate_Hz_) {
        return Error{fmt::format(
            "{} sends its position {:.0f} times a second, not {:.0f} times: set {} = 1 in "
            "odrivetool, save, restart the drive",
            can::can_arm_name(i, can_), a.positions * 1e3 / kPositions_ms, rate_Hz_,
            drives_.generation == OdriveGeneration::k06 ? "axis.config.can.encoder_msg_rate_ms"
                                                        : "axis.config.can.encoder_rate_ms")};
      }
    }
    if (can_.homing != can::Homing::kJig) return {};
    return drives_.wrong([](const Axis& a) { return a.moved_turns() > kRest_turns; },
                         can::kMovesOnJig);
  }

  can::CanBus& bus_;
  const can::CanSettings& can_;
  const OdriveSettings& own_;
  double rate_Hz_;
  OdriveListener drives_;
};

}  // namespace

std::vector<std::uint32_t> odrive_ids(const can::CanSettings& can) {
  std::vector<std::uint32_t> ids;
  for (const int node : can.node) {
    for (const OdriveCommand one :
         {OdriveCommand::kGetVersion, OdriveCommand::kHeartbeat,
          OdriveCommand::kGetEncoderEstimates, OdriveCommand::kGetEncoderCount05}) {
      ids.push_back(static_cast<std::uint32_t>(node) << 5 | static_cast<std::uint32_t>(one));
    }
    for (const std::uint8_t act : kOdriveActs)  // another sender of them is a fault
      ids.push_back(static_cast<std::uint32_t>(node) << 5 | act);
  }
  return ids;
}

int odrive_cycle_bits(const OdriveSettings& settings) {
  const int torque_bytes = static_cast<int>(odrive_torque_length(settings));
  return 3 * (can::most_can_bits(torque_bytes) + can::most_can_bits(8));
}

Result<OdriveStart> bring_up_odrives(can::CanBus& bus, const model::DeviceSettings& settings,
                                     double rate_Hz) {
  for (const int node : settings.of<can::CanSettings>().node) {
    if (node <= kOdriveLargestNode) continue;
    return Error{fmt::format("device.can.node has {}, but an ODrive's node is 0 to {}", node,
                             kOdriveLargestNode)};
  }
  if (!(rate_Hz <= kMaxRate_Hz)) {
    return Error{fmt::format(
        "rate_Hz is {}, but three drives on one CAN bus report their positions {} times "
        "a second; set rate_Hz to {} or less",
        rate_Hz, kMaxRate_Hz, kMaxRate_Hz)};
  }
  return BringUp(bus, settings, rate_Hz).run();
}

}  // namespace tact::hal::odrive
