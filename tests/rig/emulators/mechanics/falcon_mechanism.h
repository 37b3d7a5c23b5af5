// SPDX-License-Identifier: Apache-2.0
// falcon_mechanism.h - the emulated Falcon's manipulator: thigh angles and K of a grip position.
//
// Frame F is the device's: x right, y up, z towards the user. Leg frame of azimuth phi, shifted by
// (r, s); thigh t1, knee t2, side angle t3, L = d + e + b sin t3 (lengths in m, angles in rad):
//
//     pu = a cos t1 - c + L cos t2,   pv = b cos t3 - f,   pw = a sin t1 + L sin t2
//     K_i = (cos t2, cot t3, sin t2) / (a sin(t2 - t1))          in (u, v, w), then turned by phi
//     theta = 35 deg + counts x 360 deg / (1280 x 110 / 14.25)
//
// W: Wx = Fz - middle, Wy = Fx, Wz = Fy. Sources: R. Stamper, "A three degree of freedom parallel
// manipulator with only translational degrees of freedom" (Univ. of Maryland, 1997); constants as
// in github.com/libnifalcon/libnifalcon.
#pragma once

#include <cmath>

#include "tests/rig/emulators/mechanics/mechanism.h"

namespace tact::rig {

inline constexpr double kFalconRadPerCount =
    2.0 * 3.14159265358979323846 * 14.25 / (1280.0 * 110.0);
inline constexpr double kFalconZero_rad = 35.0 * 3.14159265358979323846 / 180.0;

/// Counts of the encoder, to the nearest.
inline double falcon_counts(double theta_rad) {
  return std::nearbyint((theta_rad - kFalconZero_rad) / kFalconRadPerCount);
}
/// In frame F; the weight stays zero.
std::optional<Pose> falcon_pose(const Vec3& position_m);

class FalconMechanism final : public Mechanism {
 public:
  /// `middle`: where the origin of W is on the device's axis, m; `weighing`: what gravity pulls,
  /// kg.
  FalconMechanism(double middle_m, double weighing_kg)
      : middle_m_(middle_m), weighing_kg_(weighing_kg) {}
  std::optional<Pose> pose(const Vec3& position_m) const override;
  double mass_kg() const override { return 0.25; }
  double viscous_Nms_per_rad() const override { return 0.002; }
  double coulomb_Nm() const override { return 0.002; }

 private:
  double middle_m_, weighing_kg_;
};

}  // namespace tact::rig
