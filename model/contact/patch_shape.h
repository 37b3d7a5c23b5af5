// SPDX-License-Identifier: Apache-2.0
// patch_shape.h - shape of a stepped law for viewers: displaced vertices, and the cut triangles.
//
// Fixed size, plain bytes: filled by the loop, sent by telemetry. Displacements in m, frame W, of
// vertices near the contacts; all other vertices are at rest. Each shape has a part of the list of
// all cut triangles, and the next shape the next part, so that a viewer that missed shapes gets
// the whole list in time.
#pragma once

#include <array>
#include <cstdint>

namespace tact::model::contact {

inline constexpr std::size_t kMaxShapeNodes = 180;
inline constexpr std::size_t kCutWindow = 32;

struct PatchShape {
  std::uint32_t node_count = 0;  // in use
  std::uint32_t cut_total = 0;   // triangles cut so far
  std::uint32_t cut_first = 0;   // index in the list of the first entry of cut_triangle
  std::uint32_t cut_count = 0;   // entries of cut_triangle in use
  std::array<std::uint32_t, kMaxShapeNodes> vertex{};
  std::array<std::array<float, 3>, kMaxShapeNodes> displacement_m{};
  std::array<std::uint32_t, kCutWindow> cut_triangle{};
};

}  // namespace tact::model::contact
