// SPDX-License-Identifier: Apache-2.0
// delta_dynamics.h - what the masses of a delta do: gravity torque and apparent mass.
//
//     V = -g . (m_p p + sum m_arm c_arm + sum m_f (E_i + P_i) / 2),    tau_g = dV / dtheta
//     M = I K^T K + (m_p + m_f) 1,    I = I_arm + n^2 I_rotor + 2/3 m_f la^2
//
//     m_p, m_arm, m_f  platform with handle, one upper arm, both rods of one forearm, kg
//     tau_g            torque that holds the device against gravity g, N m
//     M                mass at the hand, kg; thetadot = K v
//
// Gravity is exact for uniform rods (DK-6); splitting a rod's inertia 2/3 to the elbow and 1/3 to
// the platform is the usual approximation for M (DK-7).
#pragma once

#include "hal/delta/delta_kinematics.h"
#include "model/units.h"

namespace tact::hal::delta {

/// Gravity for a delta that lies on its side (hal/mounting.h).
inline constexpr Vec3 kGravity_W_mps2{0.0, 0.0, -model::kGravity_mps2};

struct DeltaMasses {
  double arm_kg = 0.0;
  double arm_com_m = 0.0;         // from the shoulder
  double arm_inertia_kgm2 = 0.0;  // about the shoulder
  double rotor_inertia_kgm2 = 0.0;
  double gear_ratio = 0.0;   // motor turns per joint turn
  double forearm_kg = 0.0;   // both rods of one arm
  double platform_kg = 0.0;  // with the handle
};

double joint_inertia_kgm2(const DeltaGeometry& geometry, const DeltaMasses& masses) RT_SAFE;
/// Torque that holds the device against gravity_mps2, frame D.
Joints gravity_torques_Nm(const DeltaGeometry& geometry, const DeltaMasses& masses,
                          const DeltaPose& pose, const Vec3& gravity_mps2) RT_SAFE;
/// tau = tau_g + s J^T F at the joints: holds the device against gravity_mps2 and pushes the hand
/// with force_N, frame D.
/// One s for all joints, 1 or the largest below that keeps each within most_Nm; where gravity
/// leaves no room, s is 0.
Joints drive_torques_Nm(const DeltaGeometry& geometry, const DeltaMasses& masses,
                        const DeltaPose& pose, const Vec3& gravity_mps2, const Vec3& force_N,
                        double most_Nm) RT_SAFE;
/// V up to a constant; the torque above is its slope.
double gravity_energy_J(const DeltaGeometry& geometry, const DeltaMasses& masses,
                        const DeltaPose& pose, const Vec3& gravity_mps2) RT_SAFE;
/// M.
Mat3 task_inertia_kg(const DeltaGeometry& geometry, const DeltaMasses& masses,
                     const DeltaPose& pose) RT_SAFE;

}  // namespace tact::hal::delta
