// SPDX-License-Identifier: Apache-2.0
// shapes.h - surfaces whose distance is known on paper: a plate and a ball.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "model/mesh/mesh.h"

namespace tact::tests {

/// Square plate in z = 0, facing +z, cells x cells quads of two triangles.
inline model::mesh::SurfaceMesh make_plate(double width_m, std::uint32_t cells) {
  std::vector<model::Vec3> vertices;
  std::vector<model::contact::TriangleCorners> triangles;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x)
      vertices.push_back(
          {width_m * (x / double(cells) - 0.5), width_m * (y / double(cells) - 0.5), 0});
  const auto at = [cells](std::uint32_t x, std::uint32_t y) { return y * (cells + 1) + x; };
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  return *model::mesh::make_surface_mesh(vertices, triangles);
}

/// Octahedron, every triangle split in four `levels` times, on a ball about the origin.
inline model::mesh::SurfaceMesh make_ball(double radius_m, int levels) {
  std::vector<model::Vec3> v{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<model::contact::TriangleCorners> t{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                 {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto split = [&](std::uint32_t a, std::uint32_t b) {
      const auto key = std::minmax(a, b);
      const auto [entry, is_new] = middle.try_emplace(key, static_cast<std::uint32_t>(v.size()));
      if (is_new) v.push_back(normalized(v[a] + v[b]));
      return entry->second;
    };
    std::vector<model::contact::TriangleCorners> finer;
    for (const auto& [a, b, c] : t) {
      const std::uint32_t ab = split(a, b), bc = split(b, c), ca = split(c, a);
      for (const model::contact::TriangleCorners& part :
           {model::contact::TriangleCorners{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.push_back(part);
    }
    t = finer;
  }
  for (model::Vec3& p : v) p *= radius_m;
  return *model::mesh::make_surface_mesh(v, t);
}

/// The same ball seen from inside: a bowl all round, its surface faces the origin.
inline model::mesh::SurfaceMesh make_bowl(double radius_m, int levels) {
  const model::mesh::SurfaceMesh ball = make_ball(radius_m, levels);
  std::vector<model::contact::TriangleCorners> turned;
  for (const auto& [a, b, c] : ball.triangle) turned.push_back({a, c, b});
  return *model::mesh::make_surface_mesh(ball.vertex_m, turned);
}

}  // namespace tact::tests
