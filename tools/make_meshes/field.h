// SPDX-License-Identifier: Apache-2.0
// field.h - bodies as smooth blends of round parts, and the surface of such a body.
//
// A field gives the distance of a point to the surface, mm, negative inside; only its zero and its
// sign must be exact. Nothing here calls more of the math library than sqrt, which every machine
// rounds alike, so that the choices of the mesher are the same everywhere.
#pragma once

#include <algorithm>
#include <cmath>

#include "tools/make_meshes/meshes.h"

namespace tact::tools::make_meshes {

using Field = std::function<double(const model::Vec3&)>;

/// Where a body is cut off and left open: a flat rim, square to a vessel.
struct Cut {
  model::Vec3 centre_mm{};
  model::Vec3 outward{};  // unit, along the vessel, away from the body
  double reach_mm = 0.0;  // only what lies this near to the centre is cut
};

struct Body {
  Field distance_mm;
  Field edge_ratio;             // edge length wanted at a place, as a ratio to the other places
  model::Vec3 low_mm, high_mm;  // a box round the body
  double cell_mm = 1.0;         // finer than half of the thinnest part and of the narrowest gap
  std::vector<Cut> cuts{};
};

/// The surface of a body with exactly so many vertices, and so many edges on its rims together.
/// Triangles are near equilateral; a body without cuts has no rim edges.
model::Result<Shape> make_grown(const Body& body, std::size_t vertices, std::size_t rim_edges);

/// A second body beside the first: one file, two pieces.
void append(Shape& shape, const Shape& second);

/// The surface as a grid of tetrahedra shows it: closed, then cut; sound, but of no good shape.
Shape rough_surface(const Body& body);

/// From p to the surface along the field's slope.
model::Vec3 pulled_to_surface(const Field& distance_mm, model::Vec3 p_mm, int steps);

/// The cut whose plane is the nearest to p.
const Cut& nearest_cut(const Body& body, const model::Vec3& p_mm);

// Parts.

/// Round bar from a to b whose radius goes from one to the other: two balls and the cone that
/// touches both. The ends lie further apart than the radii differ.
inline double bar_mm(const model::Vec3& p, const model::Vec3& a, double a_radius_mm,
                     const model::Vec3& b, double b_radius_mm) {
  const model::Vec3 along = normalized(b - a);
  const double length_mm = norm(b - a), y = dot(p - a, along), x = norm(p - a - y * along);
  const double sine = (a_radius_mm - b_radius_mm) / length_mm;  // of the cone's half angle
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double foot_mm = y - x * sine / cosine;  // where the cone's normal through p meets the axis
  if (foot_mm < 0.0) return norm(p - a) - a_radius_mm;
  if (foot_mm > length_mm) return norm(p - b) - b_radius_mm;
  return x * cosine + y * sine - a_radius_mm;
}

/// Ellipsoid; exact at its surface, and near enough around it.
inline double ellipsoid_mm(const model::Vec3& p, const model::Vec3& centre,
                           const model::Vec3& half) {
  const model::Vec3 d = p - centre;
  const model::Vec3 u{d.x / half.x, d.y / half.y, d.z / half.z};
  const double slope = norm(model::Vec3{u.x / half.x, u.y / half.y, u.z / half.z});
  const double from_centre = norm(u);
  return slope > 0.0 ? from_centre * (from_centre - 1.0) / slope : -half.x;
}

/// Union of two bodies with a fillet over about `blend_mm`.
inline double joined_mm(double a_mm, double b_mm, double blend_mm) {
  const double overlap = std::max(blend_mm - std::abs(a_mm - b_mm), 0.0) / blend_mm;
  return std::min(a_mm, b_mm) - 0.25 * overlap * overlap * blend_mm;
}

}  // namespace tact::tools::make_meshes
