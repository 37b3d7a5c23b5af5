// SPDX-License-Identifier: Apache-2.0
// sim_delta_model.h - the numbers of the simulated device: cylinder 360 x 300 mm, 20 N (DK-8).
//
// Lengths come from a search for the least torque and the most even force under limits on joint
// range, rod side angle and transmission; masses are those of carbon tubes, 10:1 capstans and
// motors of 6e-5 kg m^2. The delta lies on its side, its z axis pointing at the operator:
//
//     W x = D z - 0.345 m,    W y = -D y,    W z = D x
//
// so the origin of W is the middle of the cylinder, which reaches from D z = 0.195 m to 0.495 m.
#pragma once

#include "hal/delta/delta_dynamics.h"
#include "hal/delta/delta_frame.h"
#include "hal/delta/delta_kinematics.h"
#include "model/units.h"

namespace tact::hal::sim {

using model::operator""_deg;
using model::operator""_mm;

inline constexpr delta::DeltaGeometry kGeometry{
    .base_radius_m = 180_mm,
    .platform_radius_m = 50_mm,
    .upper_arm_m = 260_mm,
    .forearm_m = 400_mm,
    .azimuth_rad = {0_deg, 120_deg, 240_deg},
    .theta_min_rad = -50_deg,
    .theta_max_rad = 95_deg,
};
inline constexpr delta::DeltaMasses kMasses{
    .arm_kg = 0.25,
    .arm_com_m = 90_mm,
    .arm_inertia_kgm2 = 0.0056,
    .rotor_inertia_kgm2 = 6e-5,
    .gear_ratio = 10.0,
    .forearm_kg = 0.08,
    .platform_kg = 0.20,
};

inline constexpr double kWorkspaceRadius_m = 180_mm;
inline constexpr double kWorkspaceHalfLength_m = 150_mm;
inline constexpr double kMaxForce_N = 20.0;
inline constexpr double kMaxTorque_Nm = 0.2;
/// 5.82 N m make 20 N anywhere, 1.23 N m hold the arms: 7.05, and a little for the worst corner.
inline constexpr double kMaxJointTorque_Nm = 7.4;
inline constexpr double kMiddle_D_m = 345_mm;

using delta::direction_D;
using delta::direction_W;
constexpr model::Vec3 point_W(const model::Vec3& p_D) RT_SAFE {
  return delta::point_W(p_D, kMiddle_D_m);
}
constexpr model::Vec3 point_D(const model::Vec3& p_W) RT_SAFE {
  return delta::point_D(p_W, kMiddle_D_m);
}

}  // namespace tact::hal::sim
