// make_meshes.h - the shapes that tact ships, grown from formulas: same bytes on every run.
//
// A body is a smooth map of the unit sphere, so it is closed and has V vertices and 2 V - 4
// triangles for any V. The tool is a tube bent into a loop, so it has 2 V. A further shape is a new
// make_..._shape() and a row in the table of make_meshes.cc. Lengths here are millimetres, the unit
// of the files; triangles are counter-clockwise from outside.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "model/mesh.h"

namespace tact::tools {

struct Shape {
  std::vector<model::Vec3> vertex_mm;
  std::vector<model::TriangleCorners> triangle;
};

/// From the unit sphere to the surface of a body, mm. Smooth, and outside stays outside.
using SphereMap = std::function<model::Vec3(const model::Vec3&)>;

/// A body as triangles that are nearly equilateral on the body, not on the sphere.
model::Result<Shape> make_body(std::size_t vertices, const SphereMap& map);

/// Fewest vertices that make_body can place.
inline constexpr std::size_t kFewestVertices = 50;

/// Liver of 150 x 100 x 60 mm: long axis y, top towards +z, lower edge towards +x.
model::Result<Shape> make_liver_shape(std::size_t vertices);

/// Spring-handled forceps: tips near the origin at y = +-4 mm, handle towards +z.
/// 174 vertices, 348 triangles, one hole between pivot and spring.
model::Result<Shape> make_forceps_shape();

/// Heart on its back, 120 x 90 x 80 mm: apex towards +x, front towards +z, three open stumps of
/// vessels towards -x. 10 026 vertices, 19 409 triangles, 645 edges on the rims.
model::Result<Shape> make_heart_shape();

/// Least angle of all triangles, degrees.
double least_angle_deg(const Shape& shape);

}  // namespace tact::tools
