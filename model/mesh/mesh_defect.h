// SPDX-License-Identifier: Apache-2.0
// mesh_defect.h - what keeps a triangle list from being a surface, and at which triangle.
//
// make_surface_mesh (mesh.h) turns a defect into a message about triangle numbers; the OBJ loader
// turns the same defect into a message about lines of the file. Set-up code only.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "model/mesh/mesh.h"

namespace tact::model::mesh {

enum class MeshFlaw {
  kMissingVertex,   // a corner beyond the vertex list
  kNotFinite,       // a corner at NaN or infinity
  kRepeatedCorner,  // the same vertex twice in one triangle
  kZeroArea,        // three corners on a line, up to rounding
  kSameDirection,   // two triangles run along an edge in the same direction
  kCrowdedEdge,     // more than two triangles on an edge
};

struct MeshDefect {
  MeshFlaw flaw = MeshFlaw::kMissingVertex;
  std::uint32_t triangle = 0;  // the first that cannot stay
  std::uint32_t other = 0;     // edge flaws: an earlier triangle on that edge
  std::uint32_t from = 0;      // edge flaws: the edge as `triangle` runs along it
  std::uint32_t to = 0;
};

/// What is wrong, without where: "has zero area".
const char* what(MeshFlaw flaw);
/// What to do about it.
const char* remedy(MeshFlaw flaw);

using SurfaceOrDefect = std::variant<SurfaceMesh, MeshDefect>;

/// The work of make_surface_mesh. Needs at least one and at most 10^9 triangles.
SurfaceOrDefect build_surface(std::vector<Vec3> vertex_m,
                              std::vector<contact::TriangleCorners> triangle);

}  // namespace tact::model::mesh
