// SPDX-License-Identifier: Apache-2.0
#include "hal/delta/delta_kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact::hal::delta {
namespace {

constexpr Vec3 kAxis{0.0, 0.0, 1.0};

/// An angle of (-2 pi, 2 pi) to (-pi, pi], to compare with joint stops.
double wrapped_rad(double angle_rad) RT_SAFE {
  if (angle_rad > std::numbers::pi) return angle_rad - 2.0 * std::numbers::pi;
  if (angle_rad <= -std::numbers::pi) return angle_rad + 2.0 * std::numbers::pi;
  return angle_rad;
}

}  // namespace

DeltaKinematics::DeltaKinematics(const DeltaGeometry& geometry) : geometry_(geometry) {
  for (std::size_t i = 0; i < 3; ++i)
    outward_[i] = {std::cos(geometry.azimuth_rad[i]), std::sin(geometry.azimuth_rad[i]), 0.0};
}

DeltaInverse DeltaKinematics::inverse(const Vec3& position_m) const RT_SAFE {
  const double la = geometry_.upper_arm_m, lb = geometry_.forearm_m;
  DeltaInverse out;
  out.reachable = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& u = outward_[i];
    const double x = dot(u, position_m) - (geometry_.base_radius_m - geometry_.platform_radius_m);
    const double y = u.x * position_m.y - u.y * position_m.x;
    const double z = position_m.z;
    // DK-2: A cos theta + B sin theta = C
    const double a = 2.0 * la * x, b = 2.0 * la * z;
    const double c = x * x + y * y + z * z + la * la - lb * lb;
    const double reach = std::hypot(a, b);
    if (!(std::abs(c) <= reach && reach > 0.0)) {
      out.reachable = false;
      continue;
    }
    // theta = atan2(B, A) - acos(C / hypot(A, B)): of two solutions the elbow outward
    out.theta_rad[i] = wrapped_rad(std::atan2(b, a) - std::acos(c / reach));
  }
  return out;
}

DeltaForward DeltaKinematics::forward(const Joints& theta_rad) const RT_SAFE {
  const double r = geometry_.base_radius_m - geometry_.platform_radius_m;
  const double la = geometry_.upper_arm_m, lb = geometry_.forearm_m;
  std::array<Vec3, 3> centre;  // of the sphere on which rod i lets the platform move
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] =
        outward_[i] * (r + la * std::cos(theta_rad[i])) + kAxis * (la * std::sin(theta_rad[i]));
  }
  const Vec3 a = centre[1] - centre[0], b = centre[2] - centre[0], n = cross(a, b);
  const double aa = dot(a, a), bb = dot(b, b), nn = dot(n, n);
  if (!(nn > 1e-18 * aa * bb)) return {};  // sine below 1e-9: the centres lie on a line
  // DK-3: circumcentre - c_1 = (|a|^2 b - |b|^2 a) x n / (2 |n|^2)
  const Vec3 to_circumcentre = cross(aa * b - bb * a, n) / (2.0 * nn);
  const double height_squared = lb * lb - dot(to_circumcentre, to_circumcentre);
  // The rods are too short to meet; so written, NaN ends here too.
  if (!(height_squared >= 0.0)) return {};
  const Vec3 circumcentre = centre[0] + to_circumcentre;
  // The sign by n.z: the larger z, whichever way the arms turn n.
  const Vec3 up = n * (std::sqrt(height_squared / nn) * (n.z < 0.0 ? -1.0 : 1.0));
  return {.solved = true, .far_m = circumcentre + up};
}

DeltaPose DeltaKinematics::pose(const Vec3& position_m, const Joints& theta_rad) const RT_SAFE {
  const double r = geometry_.base_radius_m - geometry_.platform_radius_m;
  const double la = geometry_.upper_arm_m;
  DeltaPose pose;
  pose.position_m = position_m;
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = std::cos(theta_rad[i]), s = std::sin(theta_rad[i]);
    pose.radial[i] = outward_[i] * c + kAxis * s;
    // DK-4: b_i = la (-u sin theta + z cos theta)
    pose.tangent_m[i] = la * (kAxis * c - outward_[i] * s);
    // s_i = p - (u R + la radial)
    pose.rod_m[i] = position_m - (outward_[i] * r + la * pose.radial[i]);
    pose.lever_m2[i] = dot(pose.rod_m[i], pose.tangent_m[i]);
  }
  return pose;
}

Mat3 joint_rate_matrix(const DeltaPose& pose) RT_SAFE {
  Mat3 k;
  for (std::size_t i = 0; i < 3; ++i) {
    // DK-4: K_i = s_i / d_i. An arm in line with its rod (d = 0) is singular: its row stays 0
    const double d = pose.lever_m2[i];
    if (std::abs(d) > 0.0) k.row[i] = pose.rod_m[i] / d;
  }
  return k;
}

Mat3 jacobian(const DeltaPose& pose) RT_SAFE {
  // DK-4: J = S^-1 diag(d); the rows of S are the rods
  Mat3 j = inverse(Mat3{pose.rod_m});
  const Joints& d = pose.lever_m2;
  for (Vec3& row : j.row) row = {row.x * d[0], row.y * d[1], row.z * d[2]};
  return j;
}

Joints joint_torques_Nm(const DeltaPose& pose, const Vec3& force_N) RT_SAFE {
  // Each rod only pushes or pulls along itself: sum lambda_i s_i = F,  tau_i = lambda_i d_i
  const Vec3 lambda = transpose(inverse(Mat3{pose.rod_m})) * force_N;
  return {lambda.x * pose.lever_m2[0], lambda.y * pose.lever_m2[1], lambda.z * pose.lever_m2[2]};
}

Joints joint_rates_radps(const DeltaPose& pose, const Vec3& velocity_mps) RT_SAFE {
  const Vec3 rate = joint_rate_matrix(pose) * velocity_mps;
  return {rate.x, rate.y, rate.z};
}

Joints joint_drift_radps2(const DeltaPose& pose, const Vec3& velocity_mps) RT_SAFE {
  const Joints rate = joint_rates_radps(pose, velocity_mps);
  Joints drift{};
  for (std::size_t i = 0; i < 3; ++i) {
    // DK-4 once more derived: d/dt (s . v = d thetadot) with dv/dt = 0,
    // d thetaddot = |v - b thetadot|^2 + (s . la radial) thetadot^2
    const Vec3 relative = velocity_mps - rate[i] * pose.tangent_m[i];
    const double la = norm(pose.tangent_m[i]);
    const double d = pose.lever_m2[i];
    if (!(std::abs(d) > 0.0)) continue;
    drift[i] =
        (dot(relative, relative) + la * dot(pose.rod_m[i], pose.radial[i]) * rate[i] * rate[i]) / d;
  }
  return drift;
}

double saturation_ratio(const Joints& held_Nm, const Joints& wanted_Nm, double limit_Nm) RT_SAFE {
  double ratio = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double size_Nm = std::abs(wanted_Nm[i]);
    // What is held uses up one side of the limit and widens the other.
    const double room_Nm = wanted_Nm[i] > 0.0 ? limit_Nm - held_Nm[i] : limit_Nm + held_Nm[i];
    if (room_Nm >= size_Nm) continue;
    const double here = room_Nm / size_Nm;
    ratio = here > 0.0 ? std::min(ratio, here) : 0.0;  // NaN ends here too
    if (!(ratio > 0.0)) return 0.0;
  }
  return ratio;
}

}  // namespace tact::hal::delta
