// SPDX-License-Identifier: Apache-2.0
// mesh_checks.h - what makes a triangle mesh a good one: angles, crossings, pieces. For tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/mesh/mesh.h"

namespace tact::tests {

using model::Vec3;
using model::contact::TriangleCorners;
using model::mesh::SurfaceMesh;

inline double least_angle_deg(const SurfaceMesh& mesh) {
  double least_rad = 4.0;
  for (const TriangleCorners& t : mesh.triangle) {
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 a_m = mesh.vertex_m[t[(e + 1) % 3]] - mesh.vertex_m[t[e]];
      const Vec3 b_m = mesh.vertex_m[t[(e + 2) % 3]] - mesh.vertex_m[t[e]];
      least_rad = std::min(least_rad, std::atan2(norm(cross(a_m, b_m)), dot(a_m, b_m)));
    }
  }
  return least_rad * 180.0 / M_PI;
}

inline bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = cross(b - a, c - a);
  const double from = dot(p - a, n), to = dot(q - a, n);
  if (!(from * to < 0.0)) return false;
  const Vec3 x = p + (from / (from - to)) * (q - p);
  return dot(cross(b - a, x - a), n) > 0.0 && dot(cross(c - b, x - b), n) > 0.0 &&
         dot(cross(a - c, x - c), n) > 0.0;
}

// Edges of one triangle that pass through another one with no corner in common.
inline int self_crossings(const SurfaceMesh& mesh) {
  const auto at = [&](std::uint32_t t, std::size_t e) -> const Vec3& {
    return mesh.vertex_m[mesh.triangle[t][e]];
  };
  const auto low_y = [&](std::uint32_t t) {
    return std::min({at(t, 0).y, at(t, 1).y, at(t, 2).y});
  };
  const auto high_y = [&](std::uint32_t t) {
    return std::max({at(t, 0).y, at(t, 1).y, at(t, 2).y});
  };
  const auto apart = [&](std::uint32_t s, std::uint32_t t) {  // quick, by boxes along x and z
    const auto clear = [&](double Vec3::* c) {
      const auto [s_low, s_high] = std::minmax({at(s, 0).*c, at(s, 1).*c, at(s, 2).*c});
      const auto [t_low, t_high] = std::minmax({at(t, 0).*c, at(t, 1).*c, at(t, 2).*c});
      return s_high < t_low || t_high < s_low;
    };
    return clear(&Vec3::x) || clear(&Vec3::z);
  };
  std::vector<std::uint32_t> order(mesh.triangle.size());
  for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = t;
  std::sort(order.begin(), order.end(), [&](auto s, auto t) { return low_y(s) < low_y(t); });
  int found = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t s = order[i];
    for (std::size_t j = i + 1; j < order.size() && low_y(order[j]) <= high_y(s); ++j) {
      const std::uint32_t t = order[j];
      const TriangleCorners &a = mesh.triangle[s], &b = mesh.triangle[t];
      if (apart(s, t)) continue;
      if (std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end()) continue;
      for (std::size_t e = 0; e < 3; ++e) {
        found += crosses(at(s, e), at(s, (e + 1) % 3), at(t, 0), at(t, 1), at(t, 2));
        found += crosses(at(t, e), at(t, (e + 1) % 3), at(s, 0), at(s, 1), at(s, 2));
      }
    }
  }
  return found;
}

/// Number of parts that hang together: vertices joined by edges that `counts` accepts.
template <typename Counts>
int parts(const SurfaceMesh& mesh, const Counts& counts) {
  std::vector<std::uint32_t> root(mesh.vertex_m.size());
  for (std::uint32_t v = 0; v < root.size(); ++v) root[v] = v;
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  std::vector<bool> seen(root.size(), false);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      if (!counts(t, e)) continue;
      const std::uint32_t a = mesh.triangle[t][e], b = mesh.triangle[t][(e + 1) % 3];
      root[find(a)] = find(b);
      seen[a] = seen[b] = true;
    }
  }
  int found = 0;
  for (std::uint32_t v = 0; v < root.size(); ++v) found += seen[v] && root[v] == v;
  return found;
}

}  // namespace tact::tests
