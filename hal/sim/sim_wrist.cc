// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/sim_wrist.h"

#include <algorithm>
#include <cmath>

#include "model/units.h"

namespace tact::hal::sim {
namespace {

using model::operator""_deg;

// Chosen: a light handle in good bearings.
constexpr double kInertia_kgm2 = 1e-4;
constexpr double kBearing_Nms_per_rad = 1e-3;
constexpr double kMaxAngle_rad = 20_deg;

struct Axis {  // one of the three, moving by itself
  double angle_rad;
  double rate_radps;
};

Axis step_axis(Axis axis, double dt_s, double torque_Nm, double aim_rad,
               const WristPull& hand) RT_SAFE {
  const double k = hand.stiffness_Nm_per_rad;
  const double b = hand.damping_Nms_per_rad + kBearing_Nms_per_rad;
  // (I + h b + h^2 k) w+ = I w + h (torque + k (a_h - a)),  a+ = a + h w+
  const double push =
      kInertia_kgm2 * axis.rate_radps + dt_s * (torque_Nm + k * (aim_rad - axis.angle_rad));
  // Implicit in the hand's spring and damper: stable for any of them.
  const double rate_radps = push / (kInertia_kgm2 + dt_s * b + dt_s * dt_s * k);
  const double angle_rad = axis.angle_rad + dt_s * rate_radps;
  if (std::abs(angle_rad) <= kMaxAngle_rad) return {angle_rad, rate_radps};
  if (!std::isfinite(angle_rad)) return {axis.angle_rad, 0.0};
  return {std::copysign(kMaxAngle_rad, angle_rad), 0.0};  // the stop does not bounce
}

}  // namespace

SimWrist::SimWrist(const model::Vec3& start_rad) : angles_rad_(start_rad) {}

void SimWrist::step(double dt_s, const model::Vec3& torque_Nm, const WristPull& hand) RT_SAFE {
  // torque_i = e_i . T: the same axes that turn rates into angular velocity
  const double ca = std::cos(angles_rad_.x), sa = std::sin(angles_rad_.x);
  const double cb = std::cos(angles_rad_.y), sb = std::sin(angles_rad_.y);
  const model::Vec3 e1{0.0, ca, sa}, e2{sb, -sa * cb, ca * cb};
  const Axis x =
      step_axis({angles_rad_.x, rates_radps_.x}, dt_s, torque_Nm.x, hand.aim_rad.x, hand);
  const Axis y =
      step_axis({angles_rad_.y, rates_radps_.y}, dt_s, dot(e1, torque_Nm), hand.aim_rad.y, hand);
  const Axis z =
      step_axis({angles_rad_.z, rates_radps_.z}, dt_s, dot(e2, torque_Nm), hand.aim_rad.z, hand);
  angles_rad_ = {x.angle_rad, y.angle_rad, z.angle_rad};
  rates_radps_ = {x.rate_radps, y.rate_radps, z.rate_radps};
}

Quat wrist_orientation(const model::Vec3& angles_rad) RT_SAFE {
  return model::quat_from_rotation_vector({angles_rad.x, 0.0, 0.0}) *
         model::quat_from_rotation_vector({0.0, angles_rad.y, 0.0}) *
         model::quat_from_rotation_vector({0.0, 0.0, angles_rad.z});
}

model::Vec3 wrist_angular_velocity_radps(const model::Vec3& angles_rad,
                                         const model::Vec3& rates_radps) RT_SAFE {
  const double ca = std::cos(angles_rad.x), sa = std::sin(angles_rad.x);
  const double cb = std::cos(angles_rad.y), sb = std::sin(angles_rad.y);
  // omega = x adot_0 + q_x y adot_1 + q_x q_y z adot_2
  return model::Vec3{rates_radps.x, 0.0, 0.0} + rates_radps.y * model::Vec3{0.0, ca, sa} +
         rates_radps.z * model::Vec3{sb, -sa * cb, ca * cb};
}

model::Vec3 wrist_angles_rad(const model::Vec3& rotation_rad) RT_SAFE {
  const Quat q = model::quat_from_rotation_vector(rotation_rad);
  const model::Vec3 x = rotate(q, {1.0, 0.0, 0.0}), y = rotate(q, {0.0, 1.0, 0.0});
  const model::Vec3 z = rotate(q, {0.0, 0.0, 1.0});
  // R = R_x R_y R_z:  R_02 = sin a_1,  R_12/R_22 = -tan a_0,  R_01/R_00 = -tan a_2
  const model::Vec3 angles{std::atan2(-z.y, z.z), std::asin(std::clamp(z.x, -1.0, 1.0)),
                           std::atan2(-y.x, x.x)};
  // A scene may turn the hand farther than the wrist goes.
  const auto limited = [](double a) RT_SAFE {
    return std::isfinite(a) ? std::clamp(a, -kMaxAngle_rad, kMaxAngle_rad) : 0.0;
  };
  return {limited(angles.x), limited(angles.y), limited(angles.z)};
}

}  // namespace tact::hal::sim
