// SPDX-License-Identifier: Apache-2.0
#include "hal/delta/delta_dynamics.h"

#include "hal/delta/delta_frame.h"

namespace tact::hal::delta {

double joint_inertia_kgm2(const DeltaGeometry& geometry, const DeltaMasses& masses) RT_SAFE {
  // DK-7: I = I_arm + n^2 I_rotor + 2/3 m_f la^2
  return masses.arm_inertia_kgm2 +
         masses.gear_ratio * masses.gear_ratio * masses.rotor_inertia_kgm2 +
         2.0 / 3.0 * masses.forearm_kg * geometry.upper_arm_m * geometry.upper_arm_m;
}

Joints gravity_torques_Nm(const DeltaGeometry& geometry, const DeltaMasses& masses,
                          const DeltaPose& pose, const Vec3& gravity_mps2) RT_SAFE {
  // DK-6: tau_g = J^T (-(m_p + 3/2 m_f) g) - (m_arm r_com + m_f la / 2) g . e_theta
  const double carried_kg = masses.platform_kg + 1.5 * masses.forearm_kg;
  Joints torque_Nm = joint_torques_Nm(pose, -carried_kg * gravity_mps2);
  const double moment_kgm =
      masses.arm_kg * masses.arm_com_m + 0.5 * masses.forearm_kg * geometry.upper_arm_m;
  for (std::size_t i = 0; i < 3; ++i)
    // e_theta is the tangent without its length la.
    torque_Nm[i] -= moment_kgm * dot(gravity_mps2, pose.tangent_m[i]) / geometry.upper_arm_m;
  return torque_Nm;
}

Joints drive_torques_Nm(const DeltaGeometry& geometry, const DeltaMasses& masses,
                        const DeltaPose& pose, const Vec3& gravity_mps2, const Vec3& force_N,
                        double most_Nm) RT_SAFE {
  Joints torque_Nm = gravity_torques_Nm(geometry, masses, pose, gravity_mps2);
  const Joints wanted_Nm = joint_torques_Nm(pose, force_N);
  // Gravity first: a force that is cut is weaker, an arm that is not held would fall.
  const double ratio = saturation_ratio(torque_Nm, wanted_Nm, most_Nm);
  for (std::size_t i = 0; i < 3; ++i) torque_Nm[i] += ratio * wanted_Nm[i];
  return torque_Nm;
}

double gravity_energy_J(const DeltaGeometry& geometry, const DeltaMasses& masses,
                        const DeltaPose& pose, const Vec3& gravity_mps2) RT_SAFE {
  // DK-6: V = -g . ((m_p + 3/2 m_f) p + sum (m_arm r_com + m_f la / 2) radial_i)
  const double carried_kg = masses.platform_kg + 1.5 * masses.forearm_kg;
  const double moment_kgm =
      masses.arm_kg * masses.arm_com_m + 0.5 * masses.forearm_kg * geometry.upper_arm_m;
  Vec3 moment = carried_kg * pose.position_m;
  for (const Vec3& radial : pose.radial) moment += moment_kgm * radial;
  return -dot(gravity_mps2, moment);
}

Mat3 task_inertia_kg(const DeltaGeometry& geometry, const DeltaMasses& masses,
                     const DeltaPose& pose) RT_SAFE {
  // DK-7: M = I K^T K + (m_p + m_f) 1
  const Mat3 k = joint_rate_matrix(pose);
  return joint_inertia_kgm2(geometry, masses) * (transpose(k) * k) +
         model::diagonal(masses.platform_kg + masses.forearm_kg);
}

}  // namespace tact::hal::delta
