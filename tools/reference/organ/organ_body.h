// SPDX-License-Identifier: Apache-2.0
// organ_body.h - an organ around one site: refined surface, quadratic tetrahedra, what is held.
//
// Surface nodes are those of the six-node faces: three corners, then the middles of edges 01, 12
// and 20. Lengths in m, frame of the mesh file.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "model/fem/tet_mesh.h"
#include "model/mesh/mesh.h"
#include "model/result.h"
#include "tools/ground_truth/gmsh.h"
#include "tools/mesh/held_box.h"
#include "tools/reference/organ/refine_surface.h"

namespace tact::tools::reference {

using FaceNodes = std::array<std::uint32_t, 6>;

struct OrganBody {
  model::fem::TetMesh mesh;
  std::vector<FaceNodes> face;      // of the refined surface
  std::vector<model::Vec3> normal;  // of each face, outward, unit
  std::vector<std::uint32_t> held_node;
};

/// Refines the surface around `lengths.at_m`, draws the circle on it, fills it and finds the held
/// nodes: those of the triangles with all corners in the box. `largest_m` of the lengths counts
/// inside only. An error if nothing is held.
model::Result<OrganBody> make_organ_body(const model::mesh::SurfaceMesh& surface,
                                         const ground_truth::EdgeLengths& lengths,
                                         const mesh::HeldBox& held,
                                         const std::optional<Circle>& circle = {});

/// Nodes, each once, of the faces that `wanted` chooses by number.
std::vector<std::uint32_t> nodes_of_faces(const OrganBody& body,
                                          const std::function<bool(std::size_t)>& wanted);

/// Chooses the faces whose centre lies within the circle's radius of its axis, at most two radii
/// above or below its middle, and that look against the axis. `body` must outlive it.
std::function<bool(std::size_t)> faces_within(const OrganBody& body, const Circle& circle);

/// Area of the chosen faces, m^2.
double area_m2(const OrganBody& body, const std::function<bool(std::size_t)>& wanted);

/// Centre of a face's corners.
model::Vec3 centre_m(const OrganBody& body, std::size_t face);

}  // namespace tact::tools::reference
