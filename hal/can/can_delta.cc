// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_delta.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hal/can/can_error.h"
#include "hal/delta/delta_at_tool.h"
#include "hal/delta/delta_frame.h"
#include "hal/saturation.h"
#include "model/units.h"

namespace tact::hal::can {
namespace {

using model::operator""_deg;

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kStopSlack_rad = 2_deg;  // stops give, encoders are not exact

double in_deg(double angle_rad) { return angle_rad * 360.0 / kTurn_rad; }

}  // namespace

CanDelta::CanDelta(const DeltaSettings& delta, const CanSettings& can, const Vec3& gravity_mps2)
    : settings_(delta),
      gravity_D_mps2_(delta::direction_D(gravity_mps2)),
      delta_(delta),
      direction_(can.direction),
      zero_turns_(can.zero_turns),
      home_rad_(can.home_rad),
      velocity_(delta.observer_bandwidth_Hz, kJump_mps) {}

void CanDelta::home_on_jig(const delta::Joints& motor_turns) {
  for (std::size_t i = 0; i < 3; ++i) {
    // zero = turns - direction gear theta_home / 2 pi
    zero_turns_[i] =
        motor_turns[i] - direction_[i] * settings_.gear_ratio * home_rad_[i] / kTurn_rad;
  }
}

delta::Joints CanDelta::theta_rad(const delta::Joints& motor_turns) const RT_SAFE {
  delta::Joints theta_rad{};
  for (std::size_t i = 0; i < 3; ++i) {
    theta_rad[i] =
        kTurn_rad * direction_[i] * (motor_turns[i] - zero_turns_[i]) / settings_.gear_ratio;
  }
  return theta_rad;
}

std::optional<FaultCause> CanDelta::doubt(const delta::Joints& theta_rad,
                                          const delta::DeltaForward& pose) const RT_SAFE {
  for (std::size_t i = 0; i < 3; ++i) {
    const bool inside = theta_rad[i] >= settings_.theta_min_rad - kStopSlack_rad &&
                        theta_rad[i] <= settings_.theta_max_rad + kStopSlack_rad;
    if (inside) continue;
    const double mrad = std::abs(theta_rad[i]) < 1e6 ? 1000.0 * theta_rad[i] : 1e9;
    return FaultCause{.fault = Fault::kHomingLost,
                      .axis = static_cast<std::uint8_t>(i),
                      .kind = static_cast<std::uint8_t>(CanCause::kBeyondStop),
                      .code = static_cast<std::uint32_t>(static_cast<std::int32_t>(mrad))};
  }
  if (pose.solved) return std::nullopt;
  return FaultCause{.fault = Fault::kHomingLost,
                    .kind = static_cast<std::uint8_t>(CanCause::kRodsApart)};
}

std::optional<model::Error> CanDelta::check_home(const delta::Joints& motor_turns) const {
  const delta::Joints theta = theta_rad(motor_turns);
  const auto cause = doubt(theta, delta_.forward(theta));
  if (!cause) return std::nullopt;
  return model::Error{"the delta is not homed: " + homing_fault_detail(*cause, settings_)};
}

std::optional<FaultCause> CanDelta::measure(const delta::Joints& motor_turns, std::int64_t stamp_ns,
                                            Tool& tool) RT_SAFE {
  const delta::Joints theta = theta_rad(motor_turns);
  const delta::DeltaForward forward = delta_.forward(theta);
  if (const auto cause = doubt(theta, forward)) return cause;
  pose_ = delta_.pose(forward.far_m, theta);
  const double elapsed_s = 1e-9 * static_cast<double>(stamp_ns - stamp_ns_);
  stamp_ns_ = stamp_ns;
  has_pose_ = true;
  tool = Tool{};
  tool.position_m = delta::point_W(forward.far_m, settings_.middle_m);
  tool.velocity_mps = velocity_.step(tool.position_m, elapsed_s);
  return std::nullopt;
}

delta::Joints CanDelta::motor_torques_Nm(const Vec3& force_N, double ratio) const RT_SAFE {
  delta::Joints torque_Nm{};
  if (!has_pose_) return torque_Nm;
  const Vec3 borne_N = is_finite(force_N) ? saturated(force_N, settings_.max_force_N) : Vec3{};
  const double most_Nm = settings_.max_joint_torque_Nm;
  torque_Nm = delta::drive_torques_Nm(delta_.geometry(), settings_, pose_, gravity_D_mps2_,
                                      delta::direction_D(borne_N), most_Nm);
  for (std::size_t i = 0; i < 3; ++i) {
    const double joint_Nm = std::clamp(torque_Nm[i], -most_Nm, most_Nm);  // gravity may be above
    torque_Nm[i] = ratio * direction_[i] * joint_Nm / settings_.gear_ratio;
  }
  return torque_Nm;
}

DeviceInfo CanDelta::info(std::string name, double counts_per_turn, double delay_s) const {
  return {.name = std::move(name),
          .max_force_N = settings_.max_force_N,
          .max_torque_Nm = 0.0,
          .workspace_radius_m = settings_.workspace_radius_m,
          .workspace_half_length_m = settings_.workspace_half_length_m,
          .grip = GripKind::kNone,
          .at_tool = delta_at_tool(
              delta_,
              {.viscous_Nms_per_rad = settings_.joint_damping_Nms_per_rad,
               .coulomb_Nm = settings_.joint_friction_Nm,
               .counts_per_turn = counts_per_turn,
               .delay_s = delay_s},
              delta::workspace_samples_D(settings_.workspace_radius_m,
                                         settings_.workspace_half_length_m, settings_.middle_m)),
          .damping_key = "device.delta.joint_damping_Nms_per_rad"};
}

std::string can_arm_name(std::size_t axis, const CanSettings& can) {
  return fmt::format("arm {} (node {} on {})", axis + 1, can.node[axis], can.interface);
}

std::string homing_fault_detail(const FaultCause& cause, const DeltaSettings& delta) {
  switch (static_cast<CanCause>(cause.kind)) {
    case CanCause::kBeyondStop:
      return fmt::format(
          "arm {} would be at {:.0f} degrees, beyond its stops of {:.0f} and {:.0f}: put the arms "
          "on the jig and start tactd again, or correct zero_turns, direction or home_rad in "
          "device.can",
          cause.axis + 1, in_deg(1e-3 * static_cast<std::int32_t>(cause.code)),
          in_deg(delta.theta_min_rad), in_deg(delta.theta_max_rad));
    case CanCause::kRodsApart:
      return "no platform can lie where the three arms would be: put the arms on the jig and start "
             "tactd again, or correct device.can and device.delta";
    default:
      return {};
  }
}

std::string silence_fault_detail(const FaultCause& cause, const char* position) {
  switch (static_cast<CanCause>(cause.kind)) {
    case CanCause::kSilent:
      return fmt::format(
          "no heartbeat for {} ms: check its supply and the CAN cable, then start tactd again",
          cause.code);
    case CanCause::kNoPosition:
      return fmt::format(
          "no {} for {} ms: check its supply and the CAN cable, then start tactd again", position,
          cause.code);
    case CanCause::kJumped:
      return "its position jumped without motion: the encoder slips or two drives share a node; "
             "check both and home again";
    case CanCause::kSharedNode:
      return "it answers more often than it is asked: two drives have this node id, or another "
             "program answers for it; give each drive an id of its own, then start tactd again";
    default:
      return {};
  }
}

}  // namespace tact::hal::can
