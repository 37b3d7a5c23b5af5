// mesh.h - a triangle surface with what contact needs to walk over it. Built once, then spans only.
//
// Triangles are counter-clockwise seen from outside. Edge e of a triangle joins corners e and
// (e + 1) % 3. The vertex normal is the angle-weighted pseudo-normal: with it (and with the sum of
// the two face normals on an edge) the sign of the distance is right everywhere
// [Baerentzen, Aanaes, IEEE TVCG 11 (2005) 243].
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "model/result.h"
#include "model/types.h"

namespace tact::model {

using TriangleCorners = std::array<std::uint32_t, 3>;
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFu;

/// What the loop sees of a surface: spans of fixed size, nothing to own.
struct SurfaceView {
  std::span<const Vec3> vertex_m;              // n
  std::span<const TriangleCorners> triangle;   // m
  std::span<const TriangleCorners> neighbour;  // m, across edge e; kNoTriangle on a boundary
  std::span<const Vec3> face_normal;           // m, unit
  std::span<const Vec3> vertex_normal;         // n, unit
  std::span<const std::uint32_t> fan_start;    // n + 1, into fan
  std::span<const std::uint32_t> fan;          // 3 m, triangles around each vertex
};

/// Owner of the arrays behind a SurfaceView.
struct SurfaceMesh {
  std::vector<Vec3> vertex_m;
  std::vector<TriangleCorners> triangle;
  std::vector<TriangleCorners> neighbour;
  std::vector<Vec3> face_normal;
  std::vector<Vec3> vertex_normal;
  std::vector<std::uint32_t> fan_start;
  std::vector<std::uint32_t> fan;

  SurfaceView view() const {
    return {vertex_m, triangle, neighbour, face_normal, vertex_normal, fan_start, fan};
  }
};

/// Topology and normals of a sound triangle list: every edge has one or two triangles, with
/// opposite directions where two, and no triangle has zero area. Anything else is an error that
/// names the first offending triangle (counted from 0).
Result<SurfaceMesh> make_surface_mesh(std::vector<Vec3> vertex_m,
                                      std::vector<TriangleCorners> triangle);

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

}  // namespace tact::model
