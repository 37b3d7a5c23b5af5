// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_velocity_limit.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/can/can_delta.h"
#include "hal/delta/delta_kinematics.h"

namespace tact::hal::odrive {
namespace {

constexpr double kVendorsLimit_turns_per_s = 2.0, kVendorsGain_Nms_per_turn = 1.0 / 6.0;
constexpr double kOverspeed = 1.2, kHand_mps = 1.0;

/// Of the fastest motor for the hand's worst direction, in the middle of the workspace.
double motor_turns_per_m(const can::DeltaSettings& settings) {
  const delta::DeltaKinematics delta(settings);
  const Vec3 middle_m{0.0, 0.0, settings.middle_m};
  const auto inverse = delta.inverse(middle_m);
  if (!inverse.reachable) return 0.0;
  const auto pose = delta.pose(middle_m, inverse.theta_rad);
  delta::Joints squares{};
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    const delta::Joints rates = delta::joint_rates_radps(pose, axis);
    for (std::size_t i = 0; i < 3; ++i) squares[i] += rates[i] * rates[i];
  }
  const double largest = std::sqrt(std::max({squares[0], squares[1], squares[2]}));
  return largest * settings.gear_ratio / (2.0 * std::numbers::pi);
}

}  // namespace

OdriveVelocityLimit odrive_velocity_limit(const can::DeltaSettings& delta,
                                          double limit_turns_per_s) {
  const double turns_per_m = std::max(motor_turns_per_m(delta), 1e-9);
  const double torque_Nm = delta.max_joint_torque_Nm / delta.gear_ratio;
  const double cut_turns_per_s = torque_Nm / kVendorsGain_Nms_per_turn;
  return {.motor_torque_Nm = torque_Nm,
          .uncut_turns_per_s = limit_turns_per_s - cut_turns_per_s,
          .uncut_mps = (limit_turns_per_s - cut_turns_per_s) / turns_per_m,
          .stops_mps = kOverspeed * limit_turns_per_s / turns_per_m,
          .least_turns_per_s = std::ceil(cut_turns_per_s + kHand_mps * turns_per_m)};
}

model::Result<std::string> check_odrive_velocity_limit(const model::DeviceSettings& settings) {
  const double own_turns_per_s = settings.of<OdriveSettings>().max_velocity_turns_per_s;
  const bool own = own_turns_per_s > 0.0;
  const double limit_turns_per_s = own ? own_turns_per_s : kVendorsLimit_turns_per_s;
  const auto limit = odrive_velocity_limit(settings.of<can::DeltaSettings>(), limit_turns_per_s);
  const std::string remedy = fmt::format(
      "set controller.config.enable_torque_mode_vel_limit = False in odrivetool, and "
      "device.can.max_velocity_turns_per_s = {:g} or more, with max_current_A",
      limit.least_turns_per_s);
  const std::string trips =
      fmt::format("stops the drive at {:.2f} m/s of the hand", limit.stops_mps);
  const std::string at_rest = fmt::format(
      "may cut torque above {:.2f} N m at rest, of the {:.2f} N m that a motor is asked for",
      limit_turns_per_s * kVendorsGain_Nms_per_turn, limit.motor_torque_Nm);
  if (own && limit.uncut_turns_per_s <= 0.0) {
    return model::Error{fmt::format("device.can.max_velocity_turns_per_s = {:g} {}, and {}: {}",
                                    own_turns_per_s, at_rest, trips, remedy)};
  }
  if (!own) {
    return fmt::format(
        "the ODrives keep their own velocity limit, which CAN does not show; the vendor's 2 turn/s "
        "{}, and {}: {}",
        at_rest, trips, remedy);
  }
  if (limit.uncut_mps >= kHand_mps) return std::string();
  return fmt::format(
      "device.can.max_velocity_turns_per_s = {:g} may cut torque from {:.2f} m/s of the hand on, "
      "and {}: {}",
      own_turns_per_s, limit.uncut_mps, trips, remedy);
}

}  // namespace tact::hal::odrive
