// SPDX-License-Identifier: Apache-2.0
// polygon.h - a polygon in space cut into triangles by clipping ears.
//
// An ear is a corner whose triangle with its two neighbours turns with the polygon and holds no
// other corner. The roundest ear goes first, roundness = 2 A / (longest edge)^2: this picks the
// better diagonal of a quad, and leaves no flat triangle where corners lie on a straight side.
// Works for convex and concave polygons that are about flat. A polygon without an ear (it crosses
// itself) is cut as a fan; what comes of it is for the caller to check. Set-up code only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/mesh/mesh.h"

namespace tact::model::mesh {

/// Appends corners - 2 triangles that keep the turning sense. Cost about the square of the corners.
void cut_polygon(std::span<const std::uint32_t> corner, std::span<const Vec3> vertex,
                 std::vector<contact::TriangleCorners>& triangle);

}  // namespace tact::model::mesh
