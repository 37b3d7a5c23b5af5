// SPDX-License-Identifier: Apache-2.0
// boundary.h - the skin of a body of quadratic tetrahedra: its six-node triangles.
//
// Corners 0-2 counter-clockwise seen from outside, then the middles of edges 01, 12, 20. A face
// that belongs to one element only is skin. Offline only.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/fem/tet_mesh.h"

namespace tact::model::fem {

using FaceNodes = std::array<std::uint32_t, 6>;

struct Boundary {
  std::vector<FaceNodes> face;
  std::vector<std::vector<std::uint32_t>> faces_of_node;  // empty inside the body
  std::vector<Vec3> normal;                               // of each face's corners, outward, unit
};

Boundary find_boundary(const TetMesh& mesh);

/// Nodes of all skin triangles whose three corners lie in the box, its sides included.
std::vector<std::uint32_t> nodes_of_faces_in_box(const TetMesh& mesh, const Boundary& boundary,
                                                 const Vec3& low_m, const Vec3& high_m);

/// Nodes of the skin, ascending.
std::vector<std::uint32_t> skin_nodes(const Boundary& boundary);

}  // namespace tact::model::fem
