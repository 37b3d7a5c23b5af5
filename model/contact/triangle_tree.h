// SPDX-License-Identifier: Apache-2.0
// triangle_tree.h - the nearest point of a whole surface, however many sheets are near.
//
// A tree of boxes over the triangles, at most kLeafTriangles in each leaf. The pseudo-normal at the
// nearest point of all tells on which side of the surface a point lies [Baerentzen, Aanaes 2005]:
// exactly, for a closed surface that does not cross itself, however thin its parts are. A point
// whose nearest point is on the boundary of an open surface is outside.
//
// A search visits the nearer box first and at most kMaxVisits boxes; after those the nearest point
// so far stands. 20 to 24 bytes a triangle.
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

/// Of a surface with at least one triangle.
TriangleTree make_triangle_tree(const SurfaceView& surface);

/// The nearest point of all, where it is nearer than within_m; else its distance is infinite. A
/// triangle that may be near (or kNoTriangle) shortens the search.
ContactPoint nearest_contact_point(const TriangleTreeView& tree, const SurfaceView& surface,
                                   const Vec3& p_m, double within_m, std::uint32_t near) RT_SAFE;

/// Does the straight line between two points pass through the surface?
bool is_between(const TriangleTreeView& tree, const SurfaceView& surface, const Vec3& from_m,
                const Vec3& to_m) RT_SAFE;

}  // namespace tact::model::contact
