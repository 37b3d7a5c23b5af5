// SPDX-License-Identifier: Apache-2.0
// surface.h - what the loop sees of a triangle surface: spans of fixed size, nothing to own.
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

inline constexpr std::uint32_t kMaxFan = 128;  // triangles looked at around one vertex

/// All that a walk needs of one triangle, in one place of memory: a step costs nearly the same on
/// a surface that no cache holds.
struct alignas(128) TriangleRecord {
  std::array<Vec3, 3> corner_m;
  Vec3 normal;                              // unit
  TriangleCorners neighbour{};              // as SurfaceView has it
  TriangleCorners fan_start{};              // of each corner, into fan
  std::array<std::uint8_t, 3> fan_count{};  // at most kMaxFan
  std::array<bool, 3> on_boundary{};        // the corner is on a boundary
};
static_assert(sizeof(TriangleRecord) == 128);

/// Cosine between the normals of two places: skin that looks further away belongs to another side.
inline constexpr double kFacing = 0.2;

struct SurfaceView {
  std::span<const Vec3> vertex_m;              // n
  std::span<const TriangleCorners> triangle;   // m
  std::span<const TriangleCorners> neighbour;  // m, across edge e; kNoTriangle on a boundary
  std::span<const Vec3> face_normal;           // m, unit
  std::span<const Vec3> vertex_normal;         // n, unit
  std::span<const std::uint32_t> fan_start;    // n + 1, into fan
  std::span<const std::uint32_t> fan;          // 3 m, triangles around each vertex
  std::span<const TriangleRecord> record;      // m, the same once more, for contact_point.h
};

}  // namespace tact::model::contact
