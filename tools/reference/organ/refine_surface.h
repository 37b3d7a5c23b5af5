// SPDX-License-Identifier: Apache-2.0
// refine_surface.h - finer triangles near a point, on exactly the same polyhedron.
//
// Edges longer than h(middle) are split at their middle; a triangle that has a split edge also
// splits its longest one first (Rivara's longest-edge partition), so the surface stays conforming
// and no angle falls below half of the smallest that was there. Old vertices keep their numbers.
// Source: M.-C. Rivara, Int. J. Numer. Meth. Eng. 20 (1984) 745.
#pragma once

#include <vector>

#include "model/mesh/mesh.h"
#include "model/result.h"
#include "tools/ground_truth/gmsh.h"

namespace tact::tools::reference {

struct Triangles {
  std::vector<model::Vec3> vertex_m;
  std::vector<model::contact::TriangleCorners> triangle;
};

/// An error if the edges asked for are too short to be reached, or Ctrl-C was pressed.
model::Result<Triangles> refine_surface(Triangles surface,
                                        const ground_truth::EdgeLengths& lengths);

/// A circle about an axis, drawn on the surface by a cylinder.
struct Circle {
  model::Vec3 at_m{};
  model::Vec3 axis{};  // unit
  double radius_m = 0.0;

  /// Distance of a point from the axis.
  double away_m(const model::Vec3& p_m) const;
};

/// Splits edges within `reach_m` of the circle's middle where they cross the circle, so that every
/// triangle is inside or outside. A vertex nearer than a fifth of the edge counts as on the circle.
Triangles cut_along(Triangles surface, const Circle& circle, double reach_m);

}  // namespace tact::tools::reference
