// SPDX-License-Identifier: Apache-2.0
// meshes.h - the shapes that tact ships, grown from formulas: same bytes on every run.
//
// Three ways to a surface: a smooth map of the unit sphere (liver), the zero of a field
// (field.h: heart, hand, skin, gum, cover) and rings of points (forceps, injector,
// blade, press). A closed body of V vertices has 2 V - 4 triangles, one with a hole 2 V. A further
// shape is a new make_..._shape() and a row in the table of main.cc. Lengths here are
// millimetres, the unit of the files; triangles are counter-clockwise from outside. Organs have
// their top towards +z, tools their tip at the origin and their handle towards +z.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "model/mesh/mesh.h"

namespace tact::tools::make_meshes {

struct Shape {
  std::vector<model::Vec3> vertex_mm;
  std::vector<model::contact::TriangleCorners> triangle;
};

/// From the unit sphere to the surface of a body, mm. Smooth, and outside stays outside.
using SphereMap = std::function<model::Vec3(const model::Vec3&)>;

/// A body as triangles that are nearly equilateral on the body, not on the sphere.
model::Result<Shape> make_body(std::size_t vertices, const SphereMap& map);

/// Fewest vertices that make_body can place.
inline constexpr std::size_t kMinVertices = 50;

/// Liver of 150 x 100 x 60 mm: long axis y, top towards +z, lower edge towards +x.
model::Result<Shape> make_liver_shape(std::size_t vertices);

/// Spring-handled forceps: tips near the origin at y = +-4 mm, handle towards +z.
/// 174 vertices, 348 triangles, one hole between pivot and spring.
model::Result<Shape> make_forceps_shape();

/// Heart on its back, 126 x 92 x 77 mm: apex towards +x, front towards +z, three open stumps of
/// vessels towards -x. 10 026 vertices, 19 409 triangles, 645 edges on the rims.
model::Result<Shape> make_heart_shape();

/// Right hand with its forefinger down to the origin, and a cuff: two closed bodies, 180 mm tall,
/// 2 865 vertices, 5 722 triangles.
model::Result<Shape> make_hand_shape();

/// Pad of skin with what lies under it, 80 x 120 x 30 mm: 3 000 vertices, closed.
model::Result<Shape> make_skin_shape();

/// Injector: blunt round tip of 2.5 mm, 112 mm tall, 482 vertices, closed.
model::Result<Shape> make_injector_shape();

/// Gum of a jaw: U-shaped ridge, 50 x 60 x 15 mm, open towards -x, edges of 1.5 mm on its top.
model::Result<Shape> make_gum_shape();

/// Scalpel: edge from the origin up the z axis to 24 mm, facing +x; 140 mm tall, 107 vertices.
model::Result<Shape> make_blade_shape();

/// Cover plate with bolts, 104 x 124 mm, top at z = 0, and on it a gasket 6.1 mm high: two closed
/// bodies. 10 000 vertices, 19 996 triangles.
model::Result<Shape> make_cover_shape();

/// Pressing tool: ball of 4 mm on a shaft, handle from 52 to 150 mm: 738 vertices, closed.
model::Result<Shape> make_press_shape();

/// Least angle of all triangles, degrees.
double least_angle_deg(const Shape& shape);

}  // namespace tact::tools::make_meshes
