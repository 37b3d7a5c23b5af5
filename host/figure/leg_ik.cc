// SPDX-License-Identifier: Apache-2.0
#include "host/figure/leg_ik.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact::host::figure {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

bool has_length(double length_m) { return length_m > 0.0 && std::isfinite(length_m); }

/// Four times the area of a triangle; each factor is 0 exactly where the leg is straight or folded.
double four_areas_m2(double l1, double l2, double d) {
  // 16 A^2 = (L1+L2+D) (L1+L2-D) (D+(L1-L2)) (D-(L1-L2))
  const double product = ((l1 + l2) + d) * ((l1 + l2) - d) * (d + (l1 - l2)) * (d - (l1 - l2));
  return std::sqrt(std::max(product, 0.0));
}

}  // namespace

LegPose pose_leg(const Leg& leg, const Vector2d& hip_m, const Vector2d& ankle_m) {
  const double l1 = leg.thigh_m, l2 = leg.calf_m;
  if (!has_length(l1) || !has_length(l2) || !hip_m.allFinite() || !ankle_m.allFinite()) return {};

  LegPose out;
  const Vector2d ray_m = ankle_m - hip_m;
  const double wanted_m = ray_m.stableNorm();
  const double d = std::clamp(wanted_m, std::abs(l1 - l2), l1 + l2);
  const Vector2d along = wanted_m > 0.0 ? Vector2d(ray_m / wanted_m) : Vector2d::UnitX();
  out.status = d == wanted_m ? LegStatus::kOk : LegStatus::kUnreachable;

  // Knee in the frame of the ray: x = (L1^2 - L2^2 + D^2) / (2 D) ,  y = 2 A / D
  const double area_m2 = four_areas_m2(l1, l2, d);
  const double x = d > 0.0 ? 0.5 * ((l1 - l2) * (l1 + l2) / d + d) : 0.0;
  const double y = d > 0.0 ? 0.5 * area_m2 / d : l1;
  // sin(knee) = 4 A / (2 L1 L2) ,  cos(knee) = (L1^2 + L2^2 - D^2) / (2 L1 L2)
  out.interior_knee_rad = std::atan2(area_m2, l1 * l1 + l2 * l2 - d * d);
  out.interior_hip_rad = std::atan2(y, x);
  out.interior_ankle_rad = std::atan2(y, d - x);
  out.flexion_knee_rad = pi - out.interior_knee_rad;

  // thigh = phi + bend interior_hip ,  shank = thigh - bend flexion
  const double bend = leg.bend == Bend::kCounterClockwise ? 1.0 : -1.0;
  out.thigh_angle_rad = std::atan2(along.y(), along.x()) + bend * out.interior_hip_rad;
  out.shank_angle_rad = out.thigh_angle_rad - bend * out.flexion_knee_rad;
  out.knee_m = hip_m + x * along + bend * y * Vector2d(-along.y(), along.x());
  out.ankle_m = hip_m + d * along;
  return out;
}

}  // namespace tact::host::figure
