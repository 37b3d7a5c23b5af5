// SPDX-License-Identifier: Apache-2.0
// triangle_tree.h - global search of the nearest point of a surface.
//
// A tree of boxes over the triangles, at most kLeafTriangles in each leaf. The pseudo-normal at the
// nearest point gives the side of the surface on which a point lies [Baerentzen, Aanaes 2005]; this
// is exact for a closed surface that does not cross itself, also for thin parts. A point whose
// nearest point is on the boundary of an open surface counts as outside.
//
// A search visits the nearer box first and at most kMaxVisits boxes; then it returns the nearest
// point so far. 20 to 24 bytes a triangle.
#pragma once

#include <vector>

#include "model/contact/contact_point.h"

namespace tact::model::contact {

/// 32 bytes: two of them share a cache line.
struct BoxNode {
  std::array<float, 3> low_m{}, high_m{};
  std::uint32_t first = 0;  // of a leaf, into triangle; else the second child, the first is next
  std::uint32_t count = 0;  // of a leaf; 0: it has children
};
static_assert(sizeof(BoxNode) == 32);

inline constexpr std::uint32_t kLeafTriangles = 4;
inline constexpr int kMaxVisits = 1024;

struct TriangleTreeView {
  std::span<const BoxNode> node;  // the first one holds all
  std::span<const std::uint32_t> triangle;
};

struct TriangleTree {
  std::vector<BoxNode> node;
  std::vector<std::uint32_t> triangle;

  TriangleTreeView view() const { return {node, triangle}; }
};

/// The surface must have at least one triangle.
TriangleTree make_triangle_tree(const SurfaceView& surface);

/// The nearest point of the surface, if nearer than within_m; else its distance is infinite.
/// `near`, a triangle that may be near or kNoTriangle, shortens the search.
ContactPoint nearest_contact_point(const TriangleTreeView& tree, const SurfaceView& surface,
                                   const Vec3& p_m, double within_m, std::uint32_t near) RT_SAFE;

/// True if the straight line between two points passes through the surface.
bool is_between(const TriangleTreeView& tree, const SurfaceView& surface, const Vec3& from_m,
                const Vec3& to_m) RT_SAFE;

}  // namespace tact::model::contact
