// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/moteus/moteus_drive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tact::rig {
namespace {

constexpr int kMotorDriverFault = 33, kMotorNotConfigured = 36, kUnderVoltage = 40;
constexpr int kPositionInvalid = 43;
constexpr double kSupply_V = 24.0, kBoard_C = 31.0;
constexpr std::uint32_t kReplyWanted = 0x8000, kEverybody = 0x7F;

}  // namespace

MoteusDrive::MoteusDrive(int axis, int node, const MoteusSettings& settings, CanBus& bus,
                         const Motor& motor, const FaultPlan& faults)
    : axis_(axis), node_(node), settings_(settings), bus_(bus), motor_(motor), faults_(faults) {}

void MoteusDrive::power_on() {
  mode_ = kStopped;
  fault_ = 0;
  command_ = {};
}

void MoteusDrive::trip(int fault) {
  mode_ = kFault;
  fault_ = fault;
}

void MoteusDrive::fail(std::int64_t) { trip(kMotorDriverFault); }

bool MoteusDrive::tripped() { return std::exchange(has_tripped_, false); }

double MoteusDrive::torque_Nm() const {
  if (mode_ == kTimeout) {
    if (settings_.timeout_mode == kStopped) return 0.0;
    return std::clamp(-settings_.kd_Nms * motor_.velocity_turns_per_s,
                      -settings_.timeout_max_torque_Nm, settings_.timeout_max_torque_Nm);
  }
  if (mode_ != kPosition) return 0.0;
  const Command& c = command_;
  const double error_turns =
      std::isnan(c.position_turns) ? 0.0 : c.position_turns - motor_.position_turns;
  const double error_turns_per_s = c.velocity_turns_per_s - motor_.velocity_turns_per_s;
  const double torque_Nm = c.kp_scale * settings_.kp_Nm * error_turns + integral_Nm_ +
                           std::min(c.kp_scale, c.kd_scale) * settings_.kd_Nms * error_turns_per_s +
                           c.feedforward_Nm;
  const double most_Nm = std::min(settings_.max_torque_Nm, c.max_torque_Nm);
  return std::clamp(torque_Nm, -most_Nm, most_Nm);
}

bool MoteusDrive::receive(const canfd_frame& frame, std::int64_t now_ns) {
  const std::uint32_t id = frame.can_id & CAN_EFF_MASK;
  const std::uint32_t destination = id & kEverybody, source = id >> 8 & kEverybody;
  if ((frame.can_id & CAN_RTR_FLAG) != 0 || id > 0xFFFF ||
      (destination != static_cast<std::uint32_t>(node_) && destination != kEverybody) ||
      faults_.active(FaultKind::kUnpowered, axis_, now_ns))
    return false;
  has_written_ = false;
  const auto answer = serve_moteus({std::begin(frame.data), frame.len}, *this);
  if ((id & kReplyWanted) != 0) {
    bus_.send(axis_, CanRole::kSample, static_cast<std::uint32_t>(node_) << 8 | source, answer,
              now_ns);
  }
  if (!has_written_) return false;
  obey(now_ns);
  return written_.mode == kPosition;
}

void MoteusDrive::obey(std::int64_t now_ns) {
  command_ = written_;
  commanded_ns_ = now_ns;
  if (command_.mode == kStopped) {
    mode_ = kStopped;
    fault_ = 0;
  } else if (mode_ == kStopped) {
    mode_ = kPreparing;
    prepared_ns_ = now_ns + settings_.prepare_ms * std::int64_t{1'000'000};
  }
}

void MoteusDrive::tick(std::int64_t now_ns) {
  if (faults_.active(FaultKind::kUnpowered, axis_, now_ns)) return power_on();
  if (mode_ == kPreparing && now_ns >= prepared_ns_) {
    mode_ = command_.mode;
    if (!settings_.is_calibrated) trip(kMotorNotConfigured);
    if (!settings_.knows_position) trip(kPositionInvalid);
  }
  if (is_low_ && (mode_ == kPreparing || mode_ == kPosition)) trip(kUnderVoltage);
  const double dt_s = 1e-9 * static_cast<double>(now_ns - std::exchange(ticked_ns_, now_ns));
  const double error_turns = command_.position_turns - motor_.position_turns;
  if (mode_ != kPosition || std::isnan(error_turns)) {
    integral_Nm_ = 0.0;
  } else {
    integral_Nm_ = std::clamp(
        integral_Nm_ + settings_.integral_gain_Nm_per_turn_s * error_turns * std::min(dt_s, 0.01),
        -settings_.integral_limit_Nm, settings_.integral_limit_Nm);
  }
  const double timeout_s =
      command_.timeout_s == 0.0 ? settings_.default_timeout_s : command_.timeout_s;
  if (mode_ == kPosition && 1e-9 * static_cast<double>(now_ns - commanded_ns_) > timeout_s) {
    mode_ = kTimeout;
    has_tripped_ = true;
  }
}

std::optional<double> MoteusDrive::get(std::uint16_t number) const {
  if (number == settings_.unknown_register) return std::nullopt;
  switch (number) {
    case 0x000:
      return mode_;
    case 0x001:
      return settings_.knows_position ? motor_.position_turns
                                      : std::numeric_limits<double>::quiet_NaN();
    case 0x002:
      return motor_.velocity_turns_per_s;
    case 0x003:
      return torque_Nm();
    case 0x00C:
      return settings_.home_state;
    case 0x00D:
      return kSupply_V;
    case 0x00E:
      return kBoard_C;
    case 0x00F:
      return fault_;
    case 0x102:
      return settings_.register_map;
    default:
      return std::nullopt;
  }
}

bool MoteusDrive::set(std::uint16_t number, double value) {
  switch (number) {
    case 0x000:
      has_written_ = true;
      written_ = {};
      written_.mode = static_cast<int>(value);
      return true;
    case 0x020:
      written_.position_turns = value;
      return true;
    case 0x021:
      written_.velocity_turns_per_s = value;
      return true;
    case 0x022:
      written_.feedforward_Nm = value;
      return true;
    case 0x023:
      written_.kp_scale = value;
      return true;
    case 0x024:
      written_.kd_scale = value;
      return true;
    case 0x025:
      written_.max_torque_Nm = value;
      return true;
    case 0x027:
      written_.timeout_s = value;
      return true;
    default:
      return false;
  }
}

}  // namespace tact::rig
