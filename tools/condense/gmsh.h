// SPDX-License-Identifier: Apache-2.0
// gmsh.h - a closed triangle surface filled with tetrahedra by the program gmsh.
//
// The surface stays exactly as it is: its vertices are the first nodes of the body, in order, and
// its triangles are faces of elements. Elements are quadratic with straight edges. Needs gmsh 4.8
// or later (Debian: gmsh).
// Source: C. Geuzaine, J.-F. Remacle, Int. J. Numer. Meth. Eng. 79 (2009) 1309.
#pragma once

#include <span>
#include <string>

#include "model/fem/tet_mesh.h"
#include "model/mesh/mesh.h"
#include "model/result.h"

namespace tact::tools::condense {

/// Fills the surface by elements with edges of about `edge_m`. An error says what to install, or
/// keeps gmsh's log and says where.
model::Result<model::fem::TetMesh> fill_with_gmsh(
    std::span<const model::Vec3> vertex_m,
    std::span<const model::contact::TriangleCorners> triangle, double edge_m);

/// "4.8.4", of the gmsh in PATH.
model::Result<std::string> gmsh_version();

}  // namespace tact::tools::condense
