// SPDX-License-Identifier: Apache-2.0
// falcon_kinematics.h - where the grip of a Novint Falcon is, from its three thigh angles.
//
//     pu = a cos t1 - c + L cos t2,   pw = a sin t1 + L sin t2,   pv = b cos t3 - f
//     L = d + e + b sin t3
//
//     (pu, pv, pw)  grip in the frame of a leg: turned by its azimuth, shifted by (r, s), m
//     t1 t2 t3      thigh, knee and side angle of that leg, rad; t1 is driven and measured
//
// FK-1 to FK-3. Rates are exact: dt1 = [cos t2, cot t3, sin t2] . (du, dv, dw) / (a sin(t2 - t1)).
// The often copied row with sin^2 t2 in place of sin t2 sin t3 makes forces that are wrong by 12 %
// in the median. Frame of the device: z towards the user. Lengths and azimuths are those of the
// device as sold. Where frame W lies in it, and how much of it the device may use:
//
//     W x = device z - 0.120 m (towards the user),   W y = device x (right),   W z = device y (up)
//
// 0.120 m is the middle of the reach on the axis, 0.060 to 0.183 m (FK-6). Within 40 mm of it every
// pose is reachable and its transmission stays within a factor of 4.3. CHAI3D has the same radius
// and 8 N: github.com/chai3d/chai3d, src/devices/CDeltaDevices.cpp.
#pragma once

#include "hal/delta/delta_kinematics.h"
#include "model/types.h"
#include "model/units.h"

namespace tact::hal::falcon {

using model::Vec3;
using model::operator""_deg;

inline constexpr double kFalconMiddle_m = 0.120;
inline constexpr double kFalconRadius_m = 0.040;
inline constexpr double kFalconHalfLength_m = 0.040;  // along W x
inline constexpr double kFalconMaxForce_N = 8.0;

constexpr Vec3 falcon_point_W(const Vec3& p_D) RT_SAFE {
  return {p_D.z - kFalconMiddle_m, p_D.x, p_D.y};
}
constexpr Vec3 falcon_point_D(const Vec3& p_W) RT_SAFE {
  return {p_W.y, p_W.z, p_W.x + kFalconMiddle_m};
}
constexpr Vec3 falcon_direction_D(const Vec3& v_W) RT_SAFE { return {v_W.y, v_W.z, v_W.x}; }

struct FalconGeometry {
  double thigh_m = 0.060;          // a
  double shin_m = 0.1025;          // b
  double platform_m = 0.01443;     // c
  double knee_link_m = 0.01125;    // d
  double ankle_link_m = 0.01125;   // e
  double side_shift_m = -0.025;    // f
  double base_radius_m = 0.0400;   // r
  double base_shift_m = -0.02309;  // s
  delta::Joints azimuth_rad{105_deg, -15_deg, -135_deg};
};

struct FalconInverse {
  bool reachable = false;
  delta::Joints thigh_rad{};  // t1
  delta::Joints knee_rad{};   // t2
  delta::Joints side_rad{};   // t3
};

struct FalconForward {
  bool solved = false;  // the residual is below 1e-9 rad
  Vec3 position_m;
};

class FalconKinematics {
 public:
  FalconKinematics() : FalconKinematics(FalconGeometry{}) {}
  explicit FalconKinematics(const FalconGeometry& geometry);

  /// Thigh on the outer side, as built.
  FalconInverse inverse(const Vec3& position_m) const RT_SAFE;
  /// K of d thigh/dt = K v.
  model::Mat3 joint_rate_matrix(const FalconInverse& legs) const RT_SAFE;
  /// Newton on the inverse with a fixed number of steps; start near the last position, or at home.
  FalconForward forward(const delta::Joints& thigh_rad, const Vec3& start_m) const RT_SAFE;

 private:
  FalconGeometry geometry_;
  delta::Joints cos_azimuth_{}, sin_azimuth_{};
};

/// Torque of K^T tau = F, F on the hand; zero where K cannot be inverted.
delta::Joints falcon_torques_Nm(const model::Mat3& joint_rate_matrix, const Vec3& force_N) RT_SAFE;

inline constexpr Vec3 kFalconHome_m{
    0.0, 0.0, 0.110};  // all poses within 60 mm of the axis converge from here

/// Thigh angle of an encoder count (FK-4): 1280 a motor turn, 110 mm drum on a 14.25 mm shaft.
double falcon_thigh_rad(double counts) RT_SAFE;
double falcon_counts(double thigh_rad) RT_SAFE;

}  // namespace tact::hal::falcon
