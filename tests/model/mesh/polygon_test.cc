// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace tact::model::mesh::polygon_test {

std::vector<contact::TriangleCorners> cut(const std::vector<Vec3>& polygon) {
  std::vector<std::uint32_t> corners(polygon.size());
  std::iota(corners.begin(), corners.end(), 0u);
  std::vector<contact::TriangleCorners> triangles;
  cut_polygon(corners, polygon, triangles);
  EXPECT_EQ(triangles.size(), polygon.size() - 2);
  return triangles;
}

double signed_area(const std::vector<Vec3>& p, const contact::TriangleCorners& t) {
  return 0.5 * cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]).z;
}

// All triangles turn with the polygon and together have its area, so they tile it.
void expect_tiling(const std::vector<Vec3>& polygon) {
  double area = 0.0;  // shoelace
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += 0.5 * cross(polygon[i], polygon[(i + 1) % polygon.size()]).z;
  double sum = 0.0;
  for (const contact::TriangleCorners& t : cut(polygon)) {
    EXPECT_GT(signed_area(polygon, t) * area, 0.0);
    sum += signed_area(polygon, t);
  }
  EXPECT_NEAR(sum, area, 1e-9 * std::abs(area));
}

TEST(Polygon, LeavesATriangleAsItIs) {
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})[0], (contact::TriangleCorners{0, 1, 2}));
}

TEST(Polygon, TilesConvexShapes) {
  expect_tiling({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  std::vector<Vec3> ring;
  for (int i = 0; i < 300; ++i)
    ring.push_back({std::cos(i * std::numbers::pi / 150), std::sin(i * std::numbers::pi / 150), 0});
  expect_tiling(ring);
}

TEST(Polygon, TilesConcaveShapes) {
  expect_tiling({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}});                        // dart
  expect_tiling({{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}});  // L
  std::vector<Vec3> star, comb;
  for (int i = 0; i < 40; ++i) {
    const double r = i % 2 == 0 ? 1.0 : 0.3, a_rad = i * std::numbers::pi / 20;
    star.push_back({r * std::cos(a_rad), r * std::sin(a_rad), 0});
  }
  expect_tiling(star);
  for (int i = 0; i < 20; ++i) comb.push_back({double(i), i % 2 == 0 ? 1.0 : 9.0, 0});
  comb.push_back({19, 0, 0});
  comb.push_back({0, 0, 0});
  expect_tiling(comb);
}

TEST(Polygon, KeepsTheTurningSense) {
  expect_tiling({{0, 4, 0}, {1, 1, 0}, {4, 0, 0}, {0, 0, 0}});  // clockwise dart
}

TEST(Polygon, LeavesNoFlatTriangleWhereCornersLieOnAStraightSide) {
  // A triangle with the middle of each side as a further corner, and a square with nine more.
  expect_tiling({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {0, 2, 0}, {0, 1, 0}});
  std::vector<Vec3> square;
  for (int i = 0; i < 10; ++i) square.push_back({i / 10.0, 0, 0});
  square.insert(square.end(), {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  expect_tiling(square);
}

TEST(Polygon, CutsAQuadAlongItsShorterDiagonal) {
  for (const contact::TriangleCorners& t : cut({{-3, 0, 0}, {0, -1, 0}, {3, 0, 0}, {0, 1, 0}})) {
    int on_short = 0;
    for (const std::uint32_t v : t) on_short += v == 1 || v == 3;
    EXPECT_EQ(on_short, 2);
  }
}

TEST(Polygon, GivesSomethingForShapesThatAreNoPolygon) {
  cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});             // crosses itself
  cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}});  // a line
  cut({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});             // a point
  cut({{0, 0, 0}, {std::nan(""), 0, 0}, {1, 1, 0}, {0, HUGE_VAL, 0}, {2, 0, 0}});
}

}  // namespace tact::model::mesh::polygon_test
