// SPDX-License-Identifier: Apache-2.0
// surface.h - view of a triangle surface for the loop: spans of fixed size, without ownership.
//
// Triangles are counter-clockwise seen from outside. Edge e of a triangle joins corners e and
// (e + 1) % 3. The vertex normal is the angle-weighted pseudo-normal: with it (and with the sum of
// the two face normals on an edge) the sign of the distance is right everywhere
// [Baerentzen, Aanaes, IEEE TVCG 11 (2005) 243]. model/mesh/mesh.h owns the arrays.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "model/types.h"

namespace tact::model::contact {

using TriangleCorners = std::array<std::uint32_t, 3>;
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFu;

inline constexpr std::uint32_t kMaxFan = 128;  // triangles searched around one vertex

/// All data of one triangle that a search needs, contiguous in memory: a step costs nearly the same
/// if the surface does not fit in the cache.
struct alignas(128) TriangleRecord {
  std::array<Vec3, 3> corner_m;
  Vec3 normal;                              // unit
  TriangleCorners neighbour{};              // as SurfaceView has it
  TriangleCorners fan_start{};              // of each corner, into fan
  std::array<std::uint8_t, 3> fan_count{};  // at most kMaxFan
  std::array<bool, 3> on_boundary{};        // the corner is on a boundary
};
static_assert(sizeof(TriangleRecord) == 128);

/// Least cosine between the normals of two surface points on the same side of the organ.
inline constexpr double kFacing = 0.2;

struct SurfaceView {
  std::span<const Vec3> vertex_m;              // n
  std::span<const TriangleCorners> triangle;   // m
  std::span<const TriangleCorners> neighbour;  // m, across edge e; kNoTriangle on a boundary
  std::span<const Vec3> face_normal;           // m, unit
  std::span<const Vec3> vertex_normal;         // n, unit
  std::span<const std::uint32_t> fan_start;    // n + 1, into fan
  std::span<const std::uint32_t> fan;          // 3 m, triangles around each vertex
  std::span<const TriangleRecord> record;      // m, the same data for contact_point.h
};

}  // namespace tact::model::contact
