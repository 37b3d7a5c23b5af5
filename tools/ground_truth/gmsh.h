// SPDX-License-Identifier: Apache-2.0
// gmsh.h - a closed triangle surface filled with tetrahedra by the program gmsh.
//
// The surface stays exactly as it is: its vertices are the first nodes of the body, in order, and
// its triangles are faces of elements. Inside, the edge length grows from where it matters,
//
//     h(x) = min(largest, fine + growth max(0, |x - at| - radius))        a ball
//     h(x) = min(largest, fine + growth distance of x from the circle)    a circle
//
// Elements are quadratic with straight edges. Needs gmsh 4.8 or later (Debian: gmsh).
// Source: C. Geuzaine, J.-F. Remacle, Int. J. Numer. Meth. Eng. 79 (2009) 1309.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "model/fem/tet_mesh.h"
#include "model/mesh/mesh.h"
#include "model/result.h"

namespace tact::tools::ground_truth {

/// Edge lengths around a ball or some of one size, or around a circle if `axis` is not zero.
struct EdgeLengths {
  model::Vec3 at_m{};
  model::Vec3 axis{};     // unit, of the circle
  double radius_m = 0.0;  // of ball or circle
  double fine_m = 0.0;
  double growth = 0.0;                   // of the edge per distance
  double largest_m = 0.0;                // 0: no limit
  std::vector<model::Vec3> more_at_m{};  // middles of more such balls: the nearest counts

  /// h(x)
  double at(const model::Vec3& p_m) const;
};

/// Fills the surface. An error says what to install, or keeps gmsh's log and says where.
model::Result<model::fem::TetMesh> fill_with_gmsh(
    std::span<const model::Vec3> vertex_m,
    std::span<const model::contact::TriangleCorners> triangle, const EdgeLengths& lengths);

/// "4.8.4", of the gmsh in PATH.
model::Result<std::string> gmsh_version();

}  // namespace tact::tools::ground_truth
