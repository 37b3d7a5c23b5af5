// SPDX-License-Identifier: Apache-2.0
// delta_kinematics.h - the Clavel delta: three turning arms, three pairs of rods, one platform that
// never tilts.
//
//     |p - c_i| = lb,    c_i = u_i (R + la cos theta_i) + z la sin theta_i,    R = rb - rp
//     s_i . v = d_i thetadot_i,    d_i = s_i . b_i,    tau = J^T F
//
//     p, v     platform point and its velocity, frame D, m, m/s
//     theta_i  arm angle from the base plane, rad, positive towards +z
//     s_i      rod from elbow to platform, m;  b_i = dE_i / dtheta_i, m/rad
//     F        force of the device on the hand, N;  tau_i  joint torque that makes it, N m
//
// Frame D: origin in the middle of the three motor axes, +z from the base to the workspace, arm i
// at azimuth phi_i. Closed forms only (DK-1 to DK-4): the time does not depend on the pose.
// Everything is plain algebra of the loop closure; R. Clavel, EPFL thesis 925 (1991) is where the
// mechanism is from.
#pragma once

#include <array>

#include "model/mat3.h"
#include "model/types.h"

namespace tact::hal::delta {

using model::Mat3;
using model::Vec3;
using Joints = std::array<double, 3>;  // one value per arm

struct DeltaGeometry {
  double base_radius_m = 0.0;      // rb, shoulder axes
  double platform_radius_m = 0.0;  // rp
  double upper_arm_m = 0.0;        // la
  double forearm_m = 0.0;          // lb
  Joints azimuth_rad{};            // phi
  double theta_min_rad = 0.0, theta_max_rad = 0.0;
};

struct DeltaInverse {
  bool reachable = false;
  Joints theta_rad{};  // elbow outside: the branch that is built
};

struct DeltaForward {
  bool solved = false;  // false: the rods cannot meet, or their centres lie on one line
  Vec3 far_m;           // of two points the one with the larger z: the working side
};

/// What every derivative of one pose is made of.
struct DeltaPose {
  Vec3 position_m;
  std::array<Vec3, 3> rod_m;      // s_i
  std::array<Vec3, 3> radial;     // along the upper arm, u cos + z sin
  std::array<Vec3, 3> tangent_m;  // b_i
  Joints lever_m2{};              // d_i; zero where arm and rod align
};

class DeltaKinematics {
 public:
  explicit DeltaKinematics(const DeltaGeometry& geometry);

  const DeltaGeometry& geometry() const RT_SAFE { return geometry_; }
  DeltaInverse inverse(const Vec3& position_m) const RT_SAFE;
  DeltaForward forward(const Joints& theta_rad) const RT_SAFE;
  DeltaPose pose(const Vec3& position_m, const Joints& theta_rad) const RT_SAFE;

 private:
  DeltaGeometry geometry_;
  std::array<Vec3, 3> outward_;  // u_i
};

/// K of thetadot = K v; zero rows where arm and rod align.
Mat3 joint_rate_matrix(const DeltaPose& pose) RT_SAFE;
/// J of v = J thetadot; zero where the rods span no space.
Mat3 jacobian(const DeltaPose& pose) RT_SAFE;
/// J^T F without J: rod forces first, so an aligned arm is no special case.
Joints joint_torques_Nm(const DeltaPose& pose, const Vec3& force_N) RT_SAFE;
/// K v.
Joints joint_rates_radps(const DeltaPose& pose, const Vec3& velocity_mps) RT_SAFE;
/// dK/dt v: how the joints accelerate while the platform moves straight and evenly.
Joints joint_drift_radps2(const DeltaPose& pose, const Vec3& velocity_mps) RT_SAFE;

/// Largest s in [0, 1] with |held + s wanted| <= limit on each joint; 0 for NaN. One factor for all
/// joints keeps the direction of the force.
double saturation_ratio(const Joints& held_Nm, const Joints& wanted_Nm, double limit_Nm) RT_SAFE;

}  // namespace tact::hal::delta
