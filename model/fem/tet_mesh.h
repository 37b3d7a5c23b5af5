// SPDX-License-Identifier: Apache-2.0
// tet_mesh.h - a body of quadratic tetrahedra: what the condensation solves on.
//
// Ten nodes an element: corners 0-3, then the middles of edges 01, 12, 20, 03, 13, 23 (the order of
// CalculiX C3D10; gmsh swaps its last two). Offline only.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/types.h"

namespace tact::model::fem {

using TetNodes = std::array<std::uint32_t, 10>;

/// The corners of edge k, whose middle is node 4 + k.
inline constexpr std::array<std::array<std::size_t, 2>, 6> kTetEdge{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// One number for an edge, from either side.
constexpr std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
}

struct TetMesh {
  std::vector<Vec3> node_m;
  std::vector<TetNodes> element;
};

}  // namespace tact::model::fem
