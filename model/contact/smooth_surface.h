// SPDX-License-Identifier: Apache-2.0
// smooth_surface.h - a triangle mesh as one smooth surface, and the compliance of the organ at any
// of its points.
//
// w: weights of the corners x_i, x_0 = sum w_i x_i. Value and slope are known at every corner. The
// linear interpolation plus half of the change by the slopes interpolates both and is exact for a
// quadratic.
//
//     SF-1   x = x_0 + sum w_i ((x_i - x_0) . n_i) n_i / 2      surface point, m
//     SF-2   n = sum w_i n_i / |sum w_i n_i|                    normal
//     SF-3   G = sum w_i (G_i + (x - x_i) . dG_i / 2)           compliance, 3 by 3, m/N
//     SF-4   T = -(1 - n n') (sum w_i dG_i) n / 2               slope of the surface per load, 1/N
//
// All are continuous over the edges. n . dx is of second order in the angle between the corners'
// normals, so a frictionless sphere that slides over x with a force along n does almost no work.
// The corners are those of fair_surface.h, G_i and dG_i those of tissue/vertex_compliance.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "model/contact/contact_point.h"
#include "model/contact/surface.h"
#include "model/mat3.h"

namespace tact::model::contact {

constexpr Vec3 widened(const std::array<float, 3>& v) RT_SAFE {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}
constexpr std::array<float, 3> narrowed(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// A corner of the smooth surface, near the vertex of the mesh. Of single precision: 4 nm in 0.1 m.
struct SurfaceCorner {
  std::array<float, 3> at_m{}, unit{};

  Vec3 point_m() const RT_SAFE { return widened(at_m); }
  Vec3 normal() const RT_SAFE { return widened(unit); }
};

/// Regular compliance of the organ at a vertex, times E: symmetric, in W. One line of a cache.
struct alignas(64) VertexCompliance {
  std::array<float, 6> times_E_per_m{};  // xx yy zz yz zx xy
  float slope_step_times_E_per_m2 = 0.0F;
  std::array<std::array<std::int16_t, 3>, 6> slope_steps{};  // of each along the surface

  /// Slope of the k-th component.
  Vec3 slope_times_E_per_m2(std::size_t k) const RT_SAFE {
    const std::array<std::int16_t, 3>& steps = slope_steps[k];
    return static_cast<double>(slope_step_times_E_per_m2) * Vec3{static_cast<double>(steps[0]),
                                                                 static_cast<double>(steps[1]),
                                                                 static_cast<double>(steps[2])};
  }
};
static_assert(sizeof(SurfaceCorner) == 24 && sizeof(VertexCompliance) == 64);

struct SmoothSurface {
  SurfaceView mesh;
  std::span<const SurfaceCorner> corner;         // of each vertex
  std::span<const VertexCompliance> compliance;  // of each vertex, or empty: a rigid organ
  double youngs_modulus_Pa = 1.0;
};

/// A surface point with the geometry and compliance that contact needs.
struct SurfaceFrame {
  SurfacePoint surface_point;
  Vec3 point_m, normal;                             // SF-1, SF-2
  std::array<Vec3, 2> axis;                         // unit, along the triangle
  std::array<Vec3, 2> point_m_per_m, normal_per_m;  // dx and dn per unit displacement on each axis
  Mat3 compliance_m_per_N;                          // SF-3
  Mat3 slope_per_N;                                 // SF-4
};

/// SF-1 and SF-2 at frame.surface_point.
void fill_geometry(const SmoothSurface& surface, SurfaceFrame& frame) RT_SAFE;
/// SF-3 and SF-4, after fill_geometry().
void fill_compliance(const SmoothSurface& surface, SurfaceFrame& frame) RT_SAFE;

/// A point relative to a surface frame: its height along n, and its offset across n.
struct LocalPosition {
  double height_m = 0.0;
  Vec3 tangential_m;
};
LocalPosition local_position(const SurfaceFrame& frame, const Vec3& point_m) RT_SAFE;

/// Least displacement of the point x + height n over that of x; 0 at a centre of curvature.
double offset_ratio(const SurfaceFrame& frame, double height_m) RT_SAFE;

/// Displacement of the surface point that makes `tangential_m` zero: one Newton step.
Vec3 way_to_foot(const SurfaceFrame& frame, double height_m, const Vec3& tangential_m) RT_SAFE;

/// dn/dy for a point y at this height, with its foot point following, 1/m.
Mat3 normal_slope_per_m(const SurfaceFrame& frame, double height_m) RT_SAFE;

/// Moves a surface point by a vector in the plane of its triangle, over up to eight edges. Stops at
/// a boundary.
void move_along(const SurfaceView& mesh, SurfacePoint& surface_point, Vec3 way_m) RT_SAFE;

}  // namespace tact::model::contact
