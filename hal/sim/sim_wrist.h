// SPDX-License-Identifier: Apache-2.0
// sim_wrist.h - the simulated wrist: three small crossed axes at the platform point.
//
//     q = q_x(a_0) q_y(a_1) q_z(a_2),   omega = sum e_i adot_i,   torque_i = e_i . T
//     I addot_i = torque_i + k (a_h - a_i) - (b + b_w) adot_i,    |a_i| <= 20 deg
//
//     a_i  axis angles, rad;  e_i  axis directions in W;  T  torque of the motors on the hand, N m
//     k, b  spring and damper of the hand that aims at a_h, N m/rad, N m s/rad
//     b_w   damping of the bearings, N m s/rad
//
// The axes have equal inertia, are balanced and do not notice the motion of the platform.
#pragma once

#include "hal/delta/delta_kinematics.h"
#include "model/types.h"

namespace tact::hal::sim {

using model::Quat;

/// What the hand does to the wrist.
struct WristPull {
  double stiffness_Nm_per_rad = 0.0;
  double damping_Nms_per_rad = 0.0;
  model::Vec3 aim_rad;  // axis angles
};

class SimWrist {
 public:
  explicit SimWrist(const model::Vec3& start_rad);

  void step(double dt_s, const model::Vec3& torque_Nm, const WristPull& hand) RT_SAFE;
  const model::Vec3& angles_rad() const RT_SAFE { return angles_rad_; }

 private:
  model::Vec3 angles_rad_;
  model::Vec3 rates_radps_;
};

/// Tool frame to W.
Quat wrist_orientation(const model::Vec3& angles_rad) RT_SAFE;
/// W.
model::Vec3 wrist_angular_velocity_radps(const model::Vec3& angles_rad,
                                         const model::Vec3& rates_radps) RT_SAFE;
/// Axis angles of a rotation vector, each brought into the range of the wrist.
model::Vec3 wrist_angles_rad(const model::Vec3& rotation_rad) RT_SAFE;

}  // namespace tact::hal::sim
