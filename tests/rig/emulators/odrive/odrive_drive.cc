// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/odrive/odrive_drive.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tact::rig {
namespace {

constexpr std::uint32_t kTorqueControl = 1, kPassThrough = 1;
constexpr std::uint32_t kSuccess = 0, kBusy = 1, kDisarmed = 3;
constexpr double kCountsPerTurn = 10'000.0;

// Axis errors: 0.6 has one word, 0.5 points to the part that failed.
constexpr std::uint32_t kWatchdog06 = 0x0100'0000, kWatchdog05 = 0x800;
constexpr std::uint32_t kEstop06 = 0x0200'0000, kEstop05 = 0x4000;
constexpr std::uint32_t kOverCurrent06 = 0x400, kMotorFailed05 = 0x40;
constexpr double kMotorCurrentLimit05 =
    4096.0;  // bit of the motor's own error word, CURRENT_LIMIT_VIOLATION
constexpr std::uint32_t kInvalidState05 = 0x1, kUnderVoltage05 = 0x2, kUnderVoltage06 = 0x200;
constexpr std::uint32_t kControllerFailed05 = 0x200, kVelocityLimit06 = 0x8000;
constexpr double kOverspeed_ratio = 1.2, kOverspeed05 = 1.0;  // 0.5: bit of the controller's word

bool is_set_point(std::uint8_t command) { return command >= 0x0C && command <= 0x0E; }

}  // namespace

OdriveDrive::OdriveDrive(int axis, int node, const OdriveSettings& settings, CanBus& bus,
                         const Motor& motor, const FaultPlan& faults)
    : axis_(axis), node_(node), settings_(settings), bus_(bus), motor_(motor), faults_(faults) {
  power_on();
}

void OdriveDrive::power_on() {
  disarm(0);
  error_ = disarm_reason_ = 0;
  input_torque_Nm_ = 0.0;
  velocity_limit_turns_per_s_ = settings_.velocity_limit_turns_per_s;
  has_index_ = settings_.power_on_turns == 0.0;
  entered_closed_loop_ = is_overspeed_ = motor_failed_ = false;
}

double OdriveDrive::torque_Nm() const {
  if (state_ != kClosedLoop || control_mode_ != kTorqueControl || input_mode_ != kPassThrough)
    return 0.0;
  const double largest_Nm = current_limit_A_ * settings_.torque_constant_Nm_per_A;
  const double torque_Nm = std::clamp(input_torque_Nm_, -largest_Nm, largest_Nm);
  if (!settings_.torque_velocity_limit) return torque_Nm;
  const double gain = settings_.velocity_gain, at_turns_per_s = motor_.velocity_turns_per_s;
  return std::clamp(torque_Nm, (-velocity_limit_turns_per_s_ - at_turns_per_s) * gain,
                    (velocity_limit_turns_per_s_ - at_turns_per_s) * gain);
}

bool OdriveDrive::tripped() { return std::exchange(has_tripped_, false); }

void OdriveDrive::disarm(std::uint32_t error) {
  error_ |= error;
  disarm_reason_ |= error;
  if (state_ != kIdle) procedure_result_ = kDisarmed;
  state_ = kIdle;
}

void OdriveDrive::fail(std::int64_t) {
  motor_failed_ = true;
  disarm(is_05() ? kMotorFailed05 : kOverCurrent06);
}

void OdriveDrive::request_state(std::uint32_t state, std::int64_t now_ns) {
  if (state == kIdle) {
    state_ = kIdle;
    procedure_result_ = kSuccess;
  } else if (error_ != 0 || !settings_.is_calibrated || (state == kClosedLoop && !has_index_) ||
             (state != kClosedLoop && state != kIndexSearch)) {
    if (is_05()) error_ |= kInvalidState05;
    procedure_result_ = kDisarmed;
  } else {
    state_ = state;
    fed_ns_ = now_ns;
    entered_closed_loop_ |= state == kClosedLoop;
    procedure_result_ = kBusy;
    search_until_ns_ = now_ns + settings_.index_search_ms * std::int64_t{1'000'000};
    if (!settings_.motor_supply) disarm(is_05() ? kUnderVoltage05 : kUnderVoltage06);
  }
}

bool OdriveDrive::receive(const canfd_frame& frame, std::int64_t now_ns) {
  const std::uint32_t id = frame.can_id & CAN_SFF_MASK;
  if (id >> 5u != static_cast<std::uint32_t>(node_) ||
      faults_.active(FaultKind::kUnpowered, axis_, now_ns))
    return false;
  const auto number = static_cast<std::uint8_t>(id & 0x1Fu);
  if (is_05() || is_set_point(number)) fed_ns_ = now_ns;
  const OdriveMessage* const reply = odrive_reply(number, settings_.generation);
  // A request is a remote frame; the drives also take an empty data frame for one.
  if (reply != nullptr && ((frame.can_id & CAN_RTR_FLAG) != 0 || frame.len == 0)) {
    send(*reply, CanRole::kOther, now_ns);
    return false;
  }
  return (frame.can_id & CAN_RTR_FLAG) == 0 && command(frame, number, now_ns);
}

bool OdriveDrive::command(const canfd_frame& frame, std::uint8_t number, std::int64_t now_ns) {
  const std::span<const std::uint8_t> payload(std::begin(frame.data), frame.len);
  const auto value = [&](std::string_view name, std::size_t field) {
    const OdriveMessage* const message = odrive_message(name, OdriveFrom::kHost);
    return get_field(payload, message->fields[field]);
  };
  const auto word = [&](std::string_view name, std::size_t field) {
    return static_cast<std::uint32_t>(value(name, field));
  };
  switch (number) {
    case 0x02:
      disarm(is_05() ? kEstop05 : kEstop06);
      return false;
    case 0x07:
      request_state(word("set_axis_state", 0), now_ns);
      return false;
    case 0x0B:
      control_mode_ = word("set_controller_mode", 0);
      input_mode_ = word("set_controller_mode", 1);
      return false;
    case 0x0E: {
      const double torque_Nm = value("set_input_torque", 0);
      if (frame.len < 4 || !std::isfinite(torque_Nm)) return false;
      input_torque_Nm_ = torque_Nm;
      return true;
    }
    case 0x0F: {
      const double current_A = value("set_limits", 1);
      if (frame.len == 8 && std::isfinite(current_A) && current_A >= 0.0)
        current_limit_A_ = current_A;
      velocity_limit_turns_per_s_ = value("set_limits", 0);
      return false;
    }
    case 0x16:
      power_on();
      return false;
    case 0x18:
      error_ = disarm_reason_ = 0;
      motor_failed_ = is_overspeed_ = false;
      fed_ns_ = now_ns;
      return false;
    default:
      return false;
  }
}

void OdriveDrive::tick(std::int64_t now_ns) {
  if (faults_.active(FaultKind::kUnpowered, axis_, now_ns)) {
    power_on();
    return;
  }
  if (state_ == kClosedLoop &&
      std::abs(motor_.velocity_turns_per_s) > kOverspeed_ratio * velocity_limit_turns_per_s_) {
    is_overspeed_ = true;
    disarm(is_05() ? kControllerFailed05 : kVelocityLimit06);
  }
  const std::uint32_t watchdog = is_05() ? kWatchdog05 : kWatchdog06;
  const bool guarded = state_ == kClosedLoop || is_05() || settings_.watchdog_in_idle;
  if (settings_.watchdog_ms > 0 && guarded && (error_ & watchdog) == 0 &&
      now_ns - fed_ns_ > settings_.watchdog_ms * std::int64_t{1'000'000}) {
    has_tripped_ = state_ == kClosedLoop;
    disarm(watchdog);
  }
  if (state_ == kIndexSearch && now_ns >= search_until_ns_) {
    has_index_ = true;
    state_ = kIdle;
    procedure_result_ = kSuccess;
  }
  const auto cyclic = [&](int period_ms, std::uint8_t number, CanRole role) {
    if (period_ms > 0 && ticks_ % period_ms == 0)
      send(*odrive_reply(number, settings_.generation), role, now_ns);
  };
  cyclic(settings_.estimates_ms, 0x09, CanRole::kSample);
  cyclic(settings_.heartbeat_ms, 0x01, CanRole::kHeartbeat);
  if (!is_05()) cyclic(settings_.error_ms, 0x03, CanRole::kOther);
  ++ticks_;
}

void OdriveDrive::send(const OdriveMessage& message, CanRole role, std::int64_t now_ns) {
  std::array<std::uint8_t, CAN_MAX_DLEN> payload{};
  const std::span<std::uint8_t> bytes(payload.data(), message.size);
  for (const WireField& field : message.used()) put_field(bytes, field, value_of(field.name));
  const std::uint32_t id = static_cast<std::uint32_t>(node_) << 5u | message.command;
  bus_.send(axis_, role, id, bytes, now_ns);
}

double OdriveDrive::value_of(std::string_view field) const {
  const double offset_turns = has_index_ ? 0.0 : settings_.power_on_turns;
  const double counts = std::nearbyint((motor_.position_turns + offset_turns) * kCountsPerTurn);
  const double iq_A = torque_Nm() / settings_.torque_constant_Nm_per_A;
  const std::pair<std::string_view, double> values[] = {
      {"protocol", 2.0},
      {"hw_major", 4.0},
      {"hw_minor", 4.0},
      {"hw_variant", 58.0},
      {"fw_minor", 6.0},
      {"axis_error", error_},
      {"axis_state", state_},
      {"procedure_result", procedure_result_},
      {"motor_error_flag", motor_failed_ ? 1.0 : 0.0},
      {"trajectory_done", 1.0},
      {"active_errors", error_},
      {"disarm_reason", disarm_reason_},
      {"motor_error", motor_failed_ ? kMotorCurrentLimit05 : 0.0},
      {"controller_error_flag", is_overspeed_ ? 1.0 : 0.0},
      {"controller_error", is_overspeed_ ? kOverspeed05 : 0.0},
      {"pos_turns", knows_estimates() ? counts / kCountsPerTurn : 0.0},
      {"vel_turns_s", knows_estimates() ? motor_.velocity_turns_per_s : 0.0},
      {"shadow", counts},
      {"in_turn", counts - kCountsPerTurn * std::floor(counts / kCountsPerTurn)},
      {"iq_setpoint", iq_A},
      {"iq_measured", iq_A},
      {"fet", 31.5},
      {"motor", 35.5},
      {"volt", 24.0},
      {"amp", 0.4 + 0.1 * std::abs(iq_A)},
      {"target", torque_Nm()},
      {"estimate", torque_Nm()},
      {"mechanical", torque_Nm() * 2.0 * M_PI * motor_.velocity_turns_per_s},
      {"electrical", 10.0},
  };
  for (const auto& [name, value] : values)
    if (name == field) return value;
  return 0.0;
}

}  // namespace tact::rig
