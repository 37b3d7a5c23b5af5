// refine_surface.h - finer triangles near a point, on exactly the same polyhedron.
//
// Edges longer than h(middle) are split at their middle; a triangle that has a split edge also
// splits its longest one first (Rivara's longest-edge partition), so the surface stays conforming
// and no angle falls below half of the smallest that was there. Old vertices keep their numbers.
// Source: M.-C. Rivara, Int. J. Numer. Meth. Eng. 20 (1984) 745.
#pragma once

#include <vector>

#include "model/mesh.h"
#include "tools/common/gmsh.h"

namespace tact::tools {

struct Triangles {
  std::vector<model::Vec3> vertex_m;
  std::vector<model::TriangleCorners> triangle;
};

/// `fine` must be above 0.
Triangles refine_surface(Triangles surface, const EdgeLengths& lengths);

}  // namespace tact::tools
