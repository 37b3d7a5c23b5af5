// SPDX-License-Identifier: Apache-2.0
#include "model/contact/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "model/contact/blade.h"
#include "model/contact/nearest.h"

namespace tact::model::contact {
namespace {

constexpr std::size_t kMaxDepth = 64;  // halves of up to 2^32 triangles need 32

class Builder {
 public:
  Builder(const SurfaceView& surface, TriangleTree& tree) : surface_(surface), tree_(tree) {
    tree_.triangle.resize(surface.triangle.size());
    std::iota(tree_.triangle.begin(), tree_.triangle.end(), 0u);
    tree_.node.reserve(2 * surface.triangle.size() / kLeafTriangles + 2);
    add(0, static_cast<std::uint32_t>(surface.triangle.size()));
  }

 private:
  Vec3 middle_m(std::uint32_t triangle) const {
    const TriangleCorners& corner = surface_.triangle[triangle];
    return (surface_.vertex_m[corner[0]] + surface_.vertex_m[corner[1]] +
            surface_.vertex_m[corner[2]]) /
           3.0;
  }

  /// The least box of floats around the triangles from first to last.
  BoxNode box_of(std::uint32_t first, std::uint32_t last) const {
    constexpr float kMaxFloat = std::numeric_limits<float>::max();
    BoxNode box{.low_m = {kMaxFloat, kMaxFloat, kMaxFloat},
                .high_m = {-kMaxFloat, -kMaxFloat, -kMaxFloat}};
    for (std::uint32_t k = first; k < last; ++k)
      for (const std::uint32_t v : surface_.triangle[tree_.triangle[k]]) {
        const Vec3& p = surface_.vertex_m[v];
        const std::array<double, 3> axis{p.x, p.y, p.z};
        for (std::size_t a = 0; a < 3; ++a) {
          const auto rounded = static_cast<float>(axis[a]);
          box.low_m[a] = std::min(box.low_m[a], rounded);
          box.high_m[a] = std::max(box.high_m[a], rounded);
        }
      }
    for (std::size_t a = 0; a < 3; ++a) {  // rounding to float must not exclude a vertex
      box.low_m[a] = std::nextafter(box.low_m[a], -kMaxFloat);
      box.high_m[a] = std::nextafter(box.high_m[a], kMaxFloat);
    }
    return box;
  }

  // Halves along the longest side; the first child follows its parent.
  void add(std::uint32_t first, std::uint32_t last) {
    const std::size_t here = tree_.node.size();
    tree_.node.push_back(box_of(first, last));
    if (last - first <= kLeafTriangles) {
      tree_.node[here].first = first;
      tree_.node[here].count = last - first;
      return;
    }
    const BoxNode box = tree_.node[here];
    const std::array<float, 3> side_m{box.high_m[0] - box.low_m[0], box.high_m[1] - box.low_m[1],
                                      box.high_m[2] - box.low_m[2]};
    const auto axis = std::ranges::max_element(side_m) - side_m.begin();
    const auto along = [&](std::uint32_t t) {
      const Vec3 p = middle_m(t);
      return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    };
    const std::uint32_t half = first + (last - first) / 2;
    std::nth_element(tree_.triangle.begin() + first, tree_.triangle.begin() + half,
                     tree_.triangle.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) { return along(a) < along(b); });
    add(first, half);
    tree_.node[here].first = static_cast<std::uint32_t>(tree_.node.size());
    add(half, last);
  }

  const SurfaceView& surface_;
  TriangleTree& tree_;
};

double squared_distance_m2(const BoxNode& box, const Vec3& p) RT_SAFE {
  const std::array<double, 3> axis{p.x, p.y, p.z};
  double sum_m2 = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double low_m = static_cast<double>(box.low_m[a]) - axis[a];
    const double high_m = axis[a] - static_cast<double>(box.high_m[a]);
    const double away_m = std::max(0.0, std::max(low_m, high_m));
    sum_m2 += away_m * away_m;
  }
  return sum_m2;
}

// True if the segment meets the box: intersects its intervals between opposite faces.
bool meets(const BoxNode& box, const Vec3& from_m, const Vec3& to_m) RT_SAFE {
  const std::array<double, 3> from{from_m.x, from_m.y, from_m.z};
  const std::array<double, 3> way{to_m.x - from_m.x, to_m.y - from_m.y, to_m.z - from_m.z};
  double begin = 0.0, end = 1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double low_m = static_cast<double>(box.low_m[a]) - from[a];
    const double high_m = static_cast<double>(box.high_m[a]) - from[a];
    if (way[a] == 0.0) {
      if (low_m > 0.0 || high_m < 0.0) return false;
      continue;
    }
    const double one = low_m / way[a], two = high_m / way[a];
    begin = std::max(begin, std::min(one, two));
    end = std::min(end, std::max(one, two));
  }
  return begin <= end;
}

}  // namespace

TriangleTree make_triangle_tree(const SurfaceView& surface) {
  TriangleTree tree;
  Builder(surface, tree);
  return tree;
}

ContactPoint nearest_contact_point(const TriangleTreeView& tree, const SurfaceView& surface,
                                   const Vec3& p_m, double within_m, std::uint32_t near) RT_SAFE {
  struct Branch {
    std::uint32_t node;
    double squared_m2;
  };
  Nearest best;
  best.squared_m2 = within_m * within_m;
  if (near != kNoTriangle) {
    const Nearest first = nearest_on(surface, near, p_m);
    if (first.squared_m2 < best.squared_m2) best = first;
  }
  std::array<Branch, kMaxDepth> later;
  std::size_t waiting = 0;
  later[waiting++] = {0, squared_distance_m2(tree.node[0], p_m)};
  for (int visit = 0; waiting > 0 && visit < kMaxVisits; ++visit) {  // bound: kMaxVisits (boxes)
    const Branch branch = later[--waiting];
    if (!(branch.squared_m2 < best.squared_m2)) continue;
    const BoxNode& node = tree.node[branch.node];
    // bound: kLeafTriangles; kLeafTriangles * leaves in all
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const Nearest other = nearest_on(surface, tree.triangle[k], p_m);
      if (other.squared_m2 < best.squared_m2) best = other;
    }
    if (node.count > 0) continue;
    Branch one{branch.node + 1, squared_distance_m2(tree.node[branch.node + 1], p_m)};
    Branch two{node.first, squared_distance_m2(tree.node[node.first], p_m)};
    if (one.squared_m2 < two.squared_m2) std::swap(one, two);  // the nearer one is taken first
    if (waiting + 2 > kMaxDepth) continue;
    later[waiting++] = one;
    later[waiting++] = two;
  }
  if (best.surface_point.triangle != kNoTriangle) return contact_point_of(surface, best, p_m);
  ContactPoint none;
  none.distance_m = std::numeric_limits<double>::infinity();
  return none;
}

bool is_between(const TriangleTreeView& tree, const SurfaceView& surface, const Vec3& from_m,
                const Vec3& to_m) RT_SAFE {
  std::array<std::uint32_t, kMaxDepth> later;
  std::size_t waiting = 0;
  later[waiting++] = 0;
  for (int visit = 0; waiting > 0 && visit < kMaxVisits; ++visit) {  // bound: kMaxVisits (boxes)
    const std::uint32_t here = later[--waiting];
    const BoxNode& node = tree.node[here];
    if (!meets(node, from_m, to_m)) continue;
    // bound: kLeafTriangles; kLeafTriangles * leaves in all
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const auto& [a, b, c] = surface.record[tree.triangle[k]].corner_m;
      if (passes(a, b, c, from_m, to_m)) return true;
    }
    if (node.count > 0 || waiting + 2 > kMaxDepth) continue;
    later[waiting++] = here + 1;
    later[waiting++] = node.first;
  }
  return false;
}

}  // namespace tact::model::contact
