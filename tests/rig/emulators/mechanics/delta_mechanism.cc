// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/mechanics/delta_mechanism.h"

#include <cmath>

namespace tact::rig {
namespace {

constexpr double kMiddle_m = 0.345;  // of the workspace, on D's z axis
constexpr double kRim_m = 0.200, kHalfLength_m = 0.165;

constexpr Vec3 to_device(const Vec3& w) { return {w.z, -w.y, w.x}; }
constexpr Vec3 to_world(const Vec3& d) { return {d.z, -d.y, d.x}; }

}  // namespace

std::optional<Pose> delta_pose(const DeltaShape& shape, const Vec3& position_m,
                               const Vec3& gravity_mps2) {
  Pose pose;
  const double la = shape.upper_arm_m, lb = shape.forearm_m;
  pose.weight_N = gravity_mps2 * (shape.platform_kg + 1.5 * shape.forearm_kg);
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = std::cos(shape.azimuth_rad[i]), s = std::sin(shape.azimuth_rad[i]);
    const Vec3 out{c, s, 0.0}, side{-s, c, 0.0}, up{0.0, 0.0, 1.0};
    const double x = model::dot(out, position_m) - (shape.base_radius_m - shape.platform_radius_m);
    const double y = model::dot(side, position_m), z = position_m.z;
    const double a = 2.0 * la * x, b = 2.0 * la * z;
    const double cosine = (x * x + y * y + z * z + la * la - lb * lb) / std::hypot(a, b);
    if (!(std::abs(cosine) <= 1.0)) return std::nullopt;
    const double theta = std::atan2(b, a) - std::acos(cosine);
    pose.theta_rad[i] = std::remainder(theta, 2.0 * M_PI);
    const Vec3 arm = out * std::cos(theta) + up * std::sin(theta);
    const Vec3 tangent = up * std::cos(theta) - out * std::sin(theta);
    const Vec3 rod = out * x + side * y + up * z - arm * la;
    pose.k_rad_per_m[i] = rod / (la * model::dot(rod, tangent));
    // The arm's own weight and the elbow's share of the forearm, through the joint.
    const double moment_kgm =
        shape.upper_arm_kg * shape.upper_arm_com_m + 0.5 * shape.forearm_kg * la;
    pose.weight_N += pose.k_rad_per_m[i] * (moment_kgm * model::dot(gravity_mps2, tangent));
  }
  return pose;
}

std::optional<Pose> DeltaMechanism::pose(const Vec3& position_m) const {
  if (!(std::hypot(position_m.y, position_m.z) < kRim_m) ||
      !(std::abs(position_m.x) < kHalfLength_m))
    return std::nullopt;
  auto pose = delta_pose(shape_, to_device(position_m) + Vec3{0.0, 0.0, kMiddle_m},
                         to_device({0.0, 0.0, -9.81}));
  if (!pose) return pose;
  for (Vec3& row : pose->k_rad_per_m) row = to_world(row);
  pose->weight_N = to_world(pose->weight_N);
  return pose;
}

}  // namespace tact::rig
