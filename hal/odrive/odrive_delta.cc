// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_delta.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "hal/can/can_device.h"
#include "hal/can/can_open.h"
#include "hal/lines_settings.h"
#include "hal/odrive/odrive_axis.h"
#include "hal/odrive/odrive_bring_up.h"
#include "hal/odrive/odrive_errors.h"
#include "hal/odrive/odrive_listener.h"
#include "hal/odrive/odrive_protocol.h"
#include "hal/odrive/odrive_velocity_limit.h"
#include "model/time_ns.h"

namespace tact::hal::odrive {
namespace {

using can::CanLoop;
using can::CanPower;
using model::Error;
using model::Result;

constexpr int kFeedTicks = 5;      // of zero torque before closed loop is asked for
constexpr int kRepeatTicks = 100;  // a request may have been lost
constexpr std::uint32_t kWatchdog06 = 0x1000000, kWatchdog05 = 0x800;
constexpr std::uint32_t kUnderVoltage06 = 0x200, kUnderVoltage05 = 0x2;

/// Kinds of FaultCause, after those that all drives have.
enum class OdriveCause : std::uint8_t {
  kErrors05 = static_cast<std::uint8_t>(can::CanCause::kFirstOwn),  // code: axis_error of 0.5
  kErrors06,                                                        // code: axis_error of 0.6
  kParts05,         // code: 1 motor, 2 encoder, 4 controller; the axis itself reports nothing
  kLeftClosedLoop,  // code: the state it is in
  kNotStarted,      // code: the state it is in
  kNoSupply,        // waited for, before any force
};

const char* state_name(std::uint32_t state) {
  switch (static_cast<OdriveAxisState>(state)) {
    case OdriveAxisState::kIdle:
      return "idle";
    case OdriveAxisState::kFullCalibration:
      return "calibrating";
    case OdriveAxisState::kIndexSearch:
      return "looking for its index";
    case OdriveAxisState::kClosedLoop:
      return "in closed loop";
    case OdriveAxisState::kHoming:
      return "homing";
  }
  return "in another state";
}

class Odrives final : public can::CanDrives {
 public:
  Odrives(const model::DeviceSettings& settings, OdriveGeneration generation)
      : nodes_(settings.of<can::CanSettings>().node),
        torque_length_(odrive_torque_length(settings.of<OdriveSettings>())),
        generation_(generation) {}

  int node_of(const can::CanFrame& frame) const RT_SAFE override {
    return odrive_address(frame).node;
  }

  bool take(CanLoop& loop, std::size_t at, const can::CanFrame& frame,
            std::int64_t arrival_ns) RT_SAFE override {
    if (odrive_address(frame).command == OdriveCommand::kHeartbeat) {
      take_heartbeat(loop, at, frame, arrival_ns);
      return true;
    }
    const auto position = decode_odrive_estimates(frame, loop.axes[at].node);
    if (!position) return false;
    ++news_[static_cast<std::size_t>(axes_[at].take(*position, arrival_ns, loop.axes[at]))];
    return true;
  }

  bool is_command(const can::CanFrame& frame) const RT_SAFE override {
    const auto [node, command] = odrive_address(frame);
    return !frame.rtr && std::ranges::find(nodes_, node) != nodes_.end() &&
           std::ranges::find(kOdriveActs, static_cast<std::uint8_t>(command)) != kOdriveActs.end();
  }

  void update_power(CanLoop& loop) RT_SAFE override {
    if (loop.power == CanPower::kStarting && loop.asked_ns != 0 && all_in_closed_loop(loop))
      loop.become_ready();
    for (std::size_t i = 0; i < 3; ++i) {
      if (axes_[i].is_in(OdriveAxisState::kClosedLoop)) continue;
      if (loop.power == CanPower::kReady)
        loop.fail(i, OdriveCause::kLeftClosedLoop, axes_[i].state);
      if (loop.start_is_late()) loop.fail(i, OdriveCause::kNotStarted, axes_[i].state);
    }
  }

  void push(CanLoop& loop, const delta::Joints& torque_Nm) RT_SAFE override {
    push_torques(loop.bus, torque_Nm);
    const CanPower before = std::exchange(power_, loop.power);
    if (loop.power == CanPower::kReady) return;
    if (loop.power == CanPower::kOff && before != CanPower::kOff) {
      push_state(loop.bus, OdriveAxisState::kIdle);
      ticks_ = 0;
      return;
    }
    if (!std::exchange(cleared_, true))
      for (const int node : nodes_) loop.bus.push(odrive_clear_errors(node, false));
    ++ticks_;
    if (before == CanPower::kOff) {
      const bool ignored = std::any_of(axes_.begin(), axes_.end(), [](const OdriveAxis& axis) {
        return axis.is_in(OdriveAxisState::kClosedLoop);
      });
      if (ignored && ticks_ % kRepeatTicks == 0) push_state(loop.bus, OdriveAxisState::kIdle);
      if (loop.power == CanPower::kStarting) ticks_ = 0;
      return;
    }
    if (loop.asks_again()) {
      for (const int node : nodes_) loop.bus.push(odrive_clear_errors(node, false));
      ticks_ = 0;
      return;
    }
    if (ticks_ % kRepeatTicks != kFeedTicks) return;
    push_state(loop.bus, OdriveAxisState::kClosedLoop);
    if (loop.asked_ns == 0) loop.asked_ns = loop.now_ns;
  }

  void push_fault(CanLoop& loop) RT_SAFE override {
    push_torques(loop.bus, {});
    for (const int node : nodes_) loop.bus.push(odrive_estop(node));
  }

  bool push_stop(CanLoop& loop, int step) override {
    if (step < 2)
      push_torques(loop.bus, {});
    else
      push_state(loop.bus, OdriveAxisState::kIdle);
    return step < 2;
  }

  std::string text_of(const FaultCause& cause) const override {
    switch (static_cast<OdriveCause>(cause.kind)) {
      case OdriveCause::kErrors05:
        return odrive_error_message(OdriveGeneration::k05, cause.code, 0);
      case OdriveCause::kErrors06:
        return odrive_error_message(OdriveGeneration::k06, cause.code, 0);
      case OdriveCause::kParts05:
        return odrive_error_message(OdriveGeneration::k05, 0, cause.code);
      case OdriveCause::kLeftClosedLoop:
        return fmt::format(
            "the drive left torque control by itself and is {}: read its errors with odrivetool",
            state_name(cause.code));
      case OdriveCause::kNoSupply:
        return "the voltage of its motor supply is too low: switch the supply on";
      case OdriveCause::kNotStarted:
        return fmt::format(
            "the drive does not enter closed loop and is {}: calibrate it with odrivetool "
            "(axis.requested_state), then save",
            state_name(cause.code));
    }
    return {};
  }

  std::vector<DeviceCount> counters() const override {
    const auto count = [this](OdriveNews news) { return news_[static_cast<std::size_t>(news)]; };
    return {{"old", count(OdriveNews::kOld)},
            {"stale", count(OdriveNews::kStale)},
            {"jumped", count(OdriveNews::kJumped)}};
  }

 private:
  void take_heartbeat(CanLoop& loop, std::size_t at, const can::CanFrame& frame,
                      std::int64_t arrival_ns) RT_SAFE {
    const int node = loop.axes[at].node;
    const auto beat = decode_odrive_heartbeat(frame, node);
    if (!beat || !loop.axes[at].beat(arrival_ns)) return;
    axes_[at].state = beat->axis_state;
    // Between opening and the first tick the watchdogs got no frame; the first batch clears that.
    const bool was_silent =
        arrival_ns < loop.first_ns + kOdriveSilence_ns && loop.power != CanPower::kReady;
    const bool is_06 = generation_ == OdriveGeneration::k06;
    const std::uint32_t error = beat->axis_error;
    if (error == (is_06 ? kUnderVoltage06 : kUnderVoltage05) && !loop.has_shown_force)
      return loop.wait_for_power(at, OdriveCause::kNoSupply, 0);
    if (error != 0 && !(was_silent && error == (is_06 ? kWatchdog06 : kWatchdog05)))
      loop.fail(at, is_06 ? OdriveCause::kErrors06 : OdriveCause::kErrors05, error);
    if (is_06) return;
    const auto beat05 = decode_odrive_heartbeat_05(frame, node);
    const std::uint32_t parts = beat05 ? odrive_parts_05(*beat05) : 0;
    if (parts != 0) loop.fail(at, OdriveCause::kParts05, parts);
  }

  bool all_in_closed_loop(const CanLoop& loop) const RT_SAFE {
    for (std::size_t i = 0; i < 3; ++i) {
      const bool reported = loop.axes[i].heartbeat_ns > loop.asked_ns;
      if (!reported || !axes_[i].is_in(OdriveAxisState::kClosedLoop)) return false;
    }
    return true;
  }

  void push_torques(can::CanBus& bus, const delta::Joints& torque_Nm) const RT_SAFE {
    for (std::size_t i = 0; i < 3; ++i)
      bus.push(odrive_input_torque(nodes_[i], torque_Nm[i], torque_length_));
  }
  void push_state(can::CanBus& bus, OdriveAxisState state) const RT_SAFE {
    for (const int node : nodes_) bus.push(odrive_axis_state(node, state));
  }

  std::array<int, 3> nodes_;
  OdriveTorqueLength torque_length_;
  OdriveGeneration generation_;
  std::array<OdriveAxis, 3> axes_;
  CanPower power_ = CanPower::kOff;      // of the last push
  bool cleared_ = false;                 // errors of the time between opening and the first tick
  int ticks_ = 0;                        // since off, or starting
  std::array<std::uint64_t, 4> news_{};  // by OdriveNews
};

}  // namespace

Result<std::unique_ptr<Device>> start_odrive_delta(std::unique_ptr<can::CanBus> bus,
                                                   const model::DeviceSettings& settings,
                                                   double rate_Hz) {
  const auto& lines = settings.of<LinesSettings>();
  const bool powered_by_lines = lines.wired() && lines.enable >= 0;
  if (settings.of<can::CanSettings>().homing == can::Homing::kIndex && powered_by_lines) {
    return Error{
        "device.can.homing \"index\" turns the motors before the loop runs, but "
        "device.lines.enable gives them power only then: use \"absolute\" or \"jig\""};
  }
  const auto caution = check_odrive_velocity_limit(settings);
  if (!caution) return caution.error();
  const auto start = bring_up_odrives(*bus, settings, rate_Hz);
  if (!start) return start.error();
  // A position is up to a period old (the drive's own clock); then three positions and three
  // torques on the bus.
  const auto period_ns = static_cast<double>(model::period_ns(rate_Hz));
  const can::CanRate rate = bus->rate();
  return can::start_can_device(
      std::move(bus), settings, rate_Hz,
      {.drives = std::make_unique<Odrives>(settings, start->generation),
       .name = "delta with three ODrives on CAN",
       .position = "new position",
       .one_sync = false,
       .most_silent_ns = kOdriveSilence_ns,
       .counts_per_turn = settings.of<can::DeltaSettings>().counts_per_turn,
       .delay_s = 1e-9 * period_ns +
                  can::bus_time_s(odrive_cycle_bits(settings.of<OdriveSettings>()), rate),
       .motor_turns = start->motor_turns,
       .caution = *caution});
}

Result<std::unique_ptr<Device>> open_can_odrive(const model::DeviceSettings& settings,
                                                double rate_Hz) {
  const can::CanSettings& can = settings.of<can::CanSettings>();
  if (auto error = can::lock_drives(can, /*gives_sync=*/false)) return *error;
  auto socket = can::open_checked_can(
      can.interface, odrive_cycle_bits(settings.of<OdriveSettings>()), rate_Hz, odrive_ids(can));
  if (!socket) return socket.error();
  return start_odrive_delta(std::make_unique<can::CanBus>(std::move(*socket)), settings, rate_Hz);
}

}  // namespace tact::hal::odrive
