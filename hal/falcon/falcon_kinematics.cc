// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_kinematics.h"

#include <cmath>
#include <numbers>

namespace tact::hal::falcon {
namespace {

constexpr double kThighAtZero_rad = 35_deg;  // FK-4, as the next
constexpr double kRadPerCount = 2.0 * std::numbers::pi / 1280.0 * (14.25 / 110.0);
constexpr int kNewtonSteps = 12;      // from home; 3 are enough after a move of 1 mm
constexpr double kClose_rad = 1e-12;  // 1e-13 m: a further step gains rounding errors only
constexpr int kHalvings = 6;  // the first step from home may overshoot the reach at the far end

model::Vec3 difference_rad(const delta::Joints& wanted_rad, const FalconInverse& legs) RT_SAFE {
  return {wanted_rad[0] - legs.thigh_rad[0], wanted_rad[1] - legs.thigh_rad[1],
          wanted_rad[2] - legs.thigh_rad[2]};
}

}  // namespace

FalconKinematics::FalconKinematics(const FalconGeometry& geometry) : geometry_(geometry) {
  for (std::size_t i = 0; i < 3; ++i) {
    cos_azimuth_[i] = std::cos(geometry.azimuth_rad[i]);
    sin_azimuth_[i] = std::sin(geometry.azimuth_rad[i]);
  }
}

FalconInverse FalconKinematics::inverse(const model::Vec3& position_m) const RT_SAFE {
  const FalconGeometry& g = geometry_;
  FalconInverse out;
  for (std::size_t i = 0; i < 3; ++i) {
    const double c_phi = cos_azimuth_[i], s_phi = sin_azimuth_[i];
    const double pu = c_phi * position_m.x + s_phi * position_m.y - g.base_radius_m;
    const double pv = -s_phi * position_m.x + c_phi * position_m.y - g.base_shift_m;
    const double pw = position_m.z;
    // FK-1 solved for the angles: t3 = acos((pv + f) / b)
    const double side = (pv + g.side_shift_m) / g.shin_m;
    if (!(std::abs(side) < 1.0)) return {};
    const double t3 = std::acos(side);
    const double reach = g.knee_link_m + g.ankle_link_m + g.shin_m * std::sin(t3);  // L
    // A cos t1 + B sin t1 = C
    const double x = pu + g.platform_m;
    const double a = 2.0 * g.thigh_m * x, b = 2.0 * g.thigh_m * pw;
    const double c = x * x + pw * pw + g.thigh_m * g.thigh_m - reach * reach;
    const double size = std::hypot(a, b);
    if (!(std::abs(c) <= size && size > 0.0)) return {};
    const double t1 = std::atan2(b, a) - std::acos(c / size);
    out.thigh_rad[i] = t1;
    // t2 = atan2(pw - a sin t1, X - a cos t1)
    out.knee_rad[i] = std::atan2(pw - g.thigh_m * std::sin(t1), x - g.thigh_m * std::cos(t1));
    out.side_rad[i] = t3;
  }
  out.reachable = true;
  return out;
}

model::Mat3 FalconKinematics::joint_rate_matrix(const FalconInverse& legs) const RT_SAFE {
  model::Mat3 k;
  for (std::size_t i = 0; i < 3; ++i) {
    // FK-2: K_i = [cos t2, cot t3, sin t2] / (a sin(t2 - t1)), turned back by phi
    const double t2 = legs.knee_rad[i], t3 = legs.side_rad[i];
    // 0 where thigh and shin align: outside kFalconRadius_m only (falcon_kinematics.h).
    const double scale = geometry_.thigh_m * std::sin(t2 - legs.thigh_rad[i]);
    const double ku = std::cos(t2) / scale, kw = std::sin(t2) / scale;
    const double kv = std::cos(t3) / std::sin(t3) / scale;
    k.row[i] = {cos_azimuth_[i] * ku - sin_azimuth_[i] * kv,
                sin_azimuth_[i] * ku + cos_azimuth_[i] * kv, kw};
  }
  return k;
}

FalconForward FalconKinematics::forward(const delta::Joints& thigh_rad,
                                        const model::Vec3& start_m) const RT_SAFE {
  model::Vec3 p_m = start_m;
  FalconInverse legs = inverse(p_m);
  double error_rad = legs.reachable ? norm(difference_rad(thigh_rad, legs)) : 0.0;
  bool moved = legs.reachable;
  for (int step = 0; step < kNewtonSteps && moved && error_rad > kClose_rad; ++step) {
    moved = false;
    // FK-3: p <- p + K^-1 (theta - theta(p)), halved while that leaves the reach or gets worse
    model::Vec3 move_m = model::inverse(joint_rate_matrix(legs)) * difference_rad(thigh_rad, legs);
    for (int half = 0; half <= kHalvings && !moved; ++half, move_m *= 0.5) {
      const FalconInverse next = inverse(p_m + move_m);
      const double next_rad = norm(difference_rad(thigh_rad, next));
      if (!next.reachable || !(next_rad < error_rad)) continue;
      p_m += move_m;
      legs = next;
      error_rad = next_rad;
      moved = true;
    }
  }
  // 1e-9 rad is 1e-10 m, far below a count; a Newton that has stalled is farther away.
  const bool solved = legs.reachable && error_rad < 1e-9;
  return {.solved = solved, .position_m = solved ? p_m : start_m};
}

delta::Joints falcon_torques_Nm(const model::Mat3& joint_rate_matrix,
                                const model::Vec3& force_N) RT_SAFE {
  // FK-2: K^T tau = F
  const model::Vec3 torque_Nm = transpose(model::inverse(joint_rate_matrix)) * force_N;
  return {torque_Nm.x, torque_Nm.y, torque_Nm.z};
}

double falcon_thigh_rad(double counts) RT_SAFE { return kThighAtZero_rad + counts * kRadPerCount; }
double falcon_counts(double thigh_rad) RT_SAFE {
  return (thigh_rad - kThighAtZero_rad) / kRadPerCount;
}

}  // namespace tact::hal::falcon
