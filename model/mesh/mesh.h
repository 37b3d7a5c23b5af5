// SPDX-License-Identifier: Apache-2.0
// mesh.h - a triangle surface with what contact needs to walk over it (surface.h): built once, then
// looked at as a SurfaceView.
#pragma once

#include <cstdint>
#include <vector>

#include "model/contact/surface.h"
#include "model/result.h"
#include "model/types.h"

namespace tact::model::mesh {

/// Owner of the arrays behind a SurfaceView.
struct SurfaceMesh {
  std::vector<Vec3> vertex_m;
  std::vector<contact::TriangleCorners> triangle;
  std::vector<contact::TriangleCorners> neighbour;
  std::vector<Vec3> face_normal;
  std::vector<Vec3> vertex_normal;
  std::vector<std::uint32_t> fan_start;
  std::vector<std::uint32_t> fan;
  std::vector<contact::TriangleRecord> record;

  contact::SurfaceView view() const {
    return {vertex_m, triangle, neighbour, face_normal, vertex_normal, fan_start, fan, record};
  }
};

/// Topology and normals of a sound triangle list: every edge has one or two triangles, with
/// opposite directions where two, and no triangle has zero area. Anything else is an error that
/// names the first offending triangle (counted from 0).
Result<SurfaceMesh> make_surface_mesh(std::vector<Vec3> vertex_m,
                                      std::vector<contact::TriangleCorners> triangle);

/// Moves all of it.
void shift(SurfaceMesh& mesh, const Vec3& by_m);
/// Every length times `factor`, above 0.
void scale(SurfaceMesh& mesh, double factor);
/// From the other arrays, after a change of them.
void fill_records(SurfaceMesh& mesh);

/// What a person wants to know of a mesh before using it.
struct MeshSummary {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t boundary_edges = 0;  // 0: closed
  double area_m2 = 0.0;
  double volume_m3 = 0.0;  // signed, by the divergence theorem; only meaningful when closed
  Vec3 low_m, high_m;      // extent
};
MeshSummary summarize(const SurfaceMesh& mesh);

/// Parts that share no edge: an organ is one, and what else a scan has may come under the tool.
std::size_t count_parts(const SurfaceMesh& mesh);

}  // namespace tact::model::mesh
