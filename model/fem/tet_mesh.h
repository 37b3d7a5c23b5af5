// tet_mesh.h - a body of quadratic tetrahedra: what the reference and the condensation solve on.
//
// Ten nodes an element: corners 0-3, then the middles of edges 01, 12, 20, 03, 13, 23 (the order of
// CalculiX C3D10; gmsh swaps its last two). Offline only.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/types.h"

namespace tact::model::fem {

using TetNodes = std::array<std::uint32_t, 10>;

struct TetMesh {
  std::vector<Vec3> node_m;
  std::vector<TetNodes> element;
};

/// Sum of the element volumes, straight edges, m^3.
double volume_m3(const TetMesh& mesh);

}  // namespace tact::model::fem
