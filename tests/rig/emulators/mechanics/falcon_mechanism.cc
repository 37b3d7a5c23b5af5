// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/mechanics/falcon_mechanism.h"

#include <cmath>

namespace tact::rig {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr Joints kAzimuth_rad{105.0 * kDegree, -15.0 * kDegree, -135.0 * kDegree};
constexpr double kBallRim_m = 0.055;  // of the ball the stops leave
constexpr double kMinSine = 0.15;     // of the knee's bend and of the side angle

}  // namespace

std::optional<Pose> falcon_pose(const Vec3& position_m) {
  const double a = 0.060, b = 0.1025, c = 0.01443, d = 0.01125, e = 0.01125, f = -0.025;
  const double r = 0.0400, s = -0.02309;
  Pose pose;
  for (std::size_t i = 0; i < 3; ++i) {
    const double cp = std::cos(kAzimuth_rad[i]), sp = std::sin(kAzimuth_rad[i]);
    const Vec3 u{cp, sp, 0.0}, v{-sp, cp, 0.0}, w{0.0, 0.0, 1.0};
    const double pu = model::dot(u, position_m) - r, pv = model::dot(v, position_m) - s;
    const double pw = position_m.z;
    const double cos3 = (pv + f) / b;
    if (!(std::abs(cos3) < 1.0)) return std::nullopt;
    const double sin3 = std::sqrt(1.0 - cos3 * cos3);
    const double length = d + e + b * sin3, x = pu + c;
    const double cosine =
        (x * x + pw * pw + a * a - length * length) / (2.0 * a * std::hypot(x, pw));
    if (!(std::abs(cosine) <= 1.0)) return std::nullopt;
    const double t1 = std::atan2(pw, x) - std::acos(cosine);
    const double t2 = std::atan2(pw - a * std::sin(t1), x - a * std::cos(t1));
    const double bend = std::sin(t2 - t1);
    if (!(std::abs(bend) > 1e-9)) return std::nullopt;
    pose.theta_rad[i] = t1;
    pose.k_rad_per_m[i] = (u * std::cos(t2) + v * (cos3 / sin3) + w * std::sin(t2)) / (a * bend);
    if (bend < kMinSine || sin3 < kMinSine) pose.at_stop = true;
  }
  return pose;
}

std::optional<Pose> FalconMechanism::pose(const Vec3& position_m) const {
  if (!(model::norm(position_m) < kBallRim_m)) return std::nullopt;
  auto pose = falcon_pose({position_m.y, position_m.z, position_m.x + middle_m_});
  if (!pose || pose->at_stop) return std::nullopt;
  for (Vec3& row : pose->k_rad_per_m) row = {row.z, row.x, row.y};
  pose->weight_N = {0.0, 0.0, -9.81 * weighing_kg_};
  return pose;
}

}  // namespace tact::rig
