// SPDX-License-Identifier: Apache-2.0
// patch_shape.h - what a stepped law shows of itself: displaced vertices, and the cut triangles.
//
// Fixed size, plain bytes: the loop fills it, telemetry carries it. Displacements in m, frame W,
// of vertices near the contacts, the rest of the surface is at rest. Cuts are counted since the
// start and told in a window over the list that moves on with every shape, so that a viewer that
// lost some learns all of them in the end.
#pragma once

#include <array>
#include <cstdint>

namespace tact::model::contact {

inline constexpr std::size_t kMaxShapeNodes = 180;
inline constexpr std::size_t kCutWindow = 32;

struct PatchShape {
  std::uint32_t node_count = 0;  // in use
  std::uint32_t cut_total = 0;   // triangles cut so far
  std::uint32_t cut_first = 0;   // place in that list of the first one told here
  std::uint32_t cut_count = 0;   // told here
  std::array<std::uint32_t, kMaxShapeNodes> vertex{};
  std::array<std::array<float, 3>, kMaxShapeNodes> displacement_m{};
  std::array<std::uint32_t, kCutWindow> cut_triangle{};
};

}  // namespace tact::model::contact
