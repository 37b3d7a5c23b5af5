// SPDX-License-Identifier: Apache-2.0
// contact_point.h - the point of a surface nearest to a point p, followed from tick to tick.
//
//     phi   signed distance of p to the undeformed surface, m, positive outside
//     x     nearest surface point      n = grad phi = sign (p - x) / |p - x|
//
// The search steps to a neighbouring triangle while the distance falls, at most kMaxWalkSteps times
// per call: its cost does not depend on the size of the mesh. It finds the local minimum near its
// start, so that a probe pressed into a thin lobe does not jump to the far side.
#pragma once

#include <array>
#include <cmath>

#include "model/contact/surface.h"
#include "model/types.h"

namespace tact::model::contact {

inline constexpr int kMaxWalkSteps = 64;

/// A point of the undeformed surface: a triangle and the weights of its corners, with sum 1. On an
/// edge one weight is exactly 0, in a vertex two.
struct SurfacePoint {
  std::uint32_t triangle = kNoTriangle;
  std::array<double, 3> weight{};
};

/// True for a triangle of the surface and finite weights.
inline bool is_on_surface(const SurfacePoint& surface_point, const SurfaceView& surface) RT_SAFE {
  return surface_point.triangle < surface.triangle.size() &&
         std::isfinite(surface_point.weight[0]) && std::isfinite(surface_point.weight[1]) &&
         std::isfinite(surface_point.weight[2]);
}

struct ContactPoint {
  SurfacePoint surface_point;  // of x
  Vec3 point_m;                // x
  Vec3 normal;                 // n, unit
  Vec3 outward;                // pseudo-normal of the surface in x, unit
  double distance_m = 0.0;     // phi
};

/// Nearest point near `start`, a triangle of the surface; after kMaxWalkSteps the nearest so far.
ContactPoint follow(const SurfaceView& surface, std::uint32_t start, const Vec3& p_m) RT_SAFE;

}  // namespace tact::model::contact
