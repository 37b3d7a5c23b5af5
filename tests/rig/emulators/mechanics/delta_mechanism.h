// SPDX-License-Identifier: Apache-2.0
// delta_mechanism.h - the emulated delta of 360 mm diameter: joint angles, K and weight of a pose.
//
// Frame D has its origin between the motor axes and +z from the base to the workspace; the device
// lies on its side: Wx = Dz - 0.345 m, Wy = -Dy, Wz = Dx. Arm i at azimuth phi, theta from the base
// plane, leg frame turned by phi, R = rb - rp:
//
//     (x - la cos theta)^2 + y^2 + (z - la sin theta)^2 = lb^2,   x = u . p - R
//     A = 2 la x,  B = 2 la z,  C = |(x, y, z)|^2 + la^2 - lb^2
//     theta = atan2(B, A) - acos(C / hypot(A, B))                       the elbow-out branch
//     s = P - E,  d = s . dE/dtheta,  K_i = s / d
//     V = -g . (m_p p + sum m_arm c_i + sum m_f (E_i + P_i) / 2)
//
// Sources: R. Clavel, "Conception d'un robot parallele rapide a 4 degres de liberte" (EPFL 925,
// 1991); the statics follow by virtual work.
#pragma once

#include "tests/rig/emulators/mechanics/mechanism.h"

namespace tact::rig {

struct DeltaShape {
  double base_radius_m = 0.180, platform_radius_m = 0.050;
  double upper_arm_m = 0.260, forearm_m = 0.400;
  Joints azimuth_rad{0.0, 2.0943951023931953, 4.1887902047863905};
  double upper_arm_kg = 0.25, upper_arm_com_m = 0.09;  // com: from the shoulder
  double forearm_kg = 0.08, platform_kg = 0.20;        // forearm: both rods of one arm
};

/// In frame D; `gravity` in m/s^2. Nothing where an arm does not reach.
std::optional<Pose> delta_pose(const DeltaShape& shape, const Vec3& position_m,
                               const Vec3& gravity_mps2);

class DeltaMechanism final : public Mechanism {
 public:
  std::optional<Pose> pose(const Vec3& position_m) const override;
  double mass_kg() const override { return 0.5; }  // apparent, in the middle of the workspace
  double viscous_Nms_per_rad() const override { return 0.05; }
  double coulomb_Nm() const override { return 0.01; }

 private:
  DeltaShape shape_{};
};

}  // namespace tact::rig
