// SPDX-License-Identifier: Apache-2.0
#include "model/fem/boundary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/fem/tet_blocks.h"

namespace tact::model::fem::boundary_test {

// 3 x 2 x 1 cells of 10 mm.
TetMesh block() {
  return tests::tet_block({0.0, 0.01, 0.02, 0.03}, {0.0, 0.01, 0.02}, {0.0, 0.01});
}

TEST(Boundary, IsTheWholeSkinAndLooksOutward) {
  const TetMesh mesh = block();
  const Boundary skin = find_boundary(mesh);
  EXPECT_EQ(skin.face.size(), 2u * 2u * (3u * 2u + 3u * 1u + 2u * 1u));
  double area_m2 = 0.0, flux_m3 = 0.0;
  for (std::size_t i = 0; i < skin.face.size(); ++i) {
    const FaceNodes& f = skin.face[i];
    const Vec3 &a = mesh.node_m[f[0]], &b = mesh.node_m[f[1]], &c = mesh.node_m[f[2]];
    area_m2 += 0.5 * norm(cross(b - a, c - a));
    // Divergence theorem about a point inside: outward faces give the volume, each a positive part.
    const Vec3 o{0.014, 0.009, 0.004};
    const double part_m3 = dot(a - o, cross(b - o, c - o)) / 6.0;
    EXPECT_GT(part_m3, 0.0);
    flux_m3 += part_m3;
    EXPECT_NEAR(dot(skin.normal[i], normalized(cross(b - a, c - a))), 1.0, 1e-12);
    EXPECT_LT(norm(mesh.node_m[f[3]] - 0.5 * (a + b)), 1e-15);
    EXPECT_LT(norm(mesh.node_m[f[4]] - 0.5 * (b + c)), 1e-15);
    EXPECT_LT(norm(mesh.node_m[f[5]] - 0.5 * (c + a)), 1e-15);
  }
  EXPECT_NEAR(area_m2, 2.0 * (6e-4 + 3e-4 + 2e-4), 1e-15);
  EXPECT_NEAR(flux_m3, 6e-6, 1e-18);
}

TEST(Boundary, ABoxHoldsTheTrianglesThatLieInIt) {
  const TetMesh mesh = block();
  const Boundary skin = find_boundary(mesh);
  const auto held = nodes_of_faces_in_box(mesh, skin, {-1.0, -1.0, -1.0}, {0.001, 1.0, 1.0});
  EXPECT_EQ(held.size(), 5u * 3u) << "the face x = 0: corners and middles";
  for (const std::uint32_t node : held) EXPECT_EQ(mesh.node_m[node].x, 0.0);
  EXPECT_TRUE(nodes_of_faces_in_box(mesh, skin, {5.0, 5.0, 5.0}, {6.0, 6.0, 6.0}).empty());
}

TEST(Boundary, SkinNodesAreThoseOfItsFaces) {
  const TetMesh mesh = tests::tet_block({0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}, {0.0, 1.0, 2.0});
  const Boundary skin = find_boundary(mesh);
  const auto nodes = skin_nodes(skin);
  EXPECT_EQ(nodes.size(), 98u);  // 5^3 - 3^3: a quadratic node at every half step
  for (const std::uint32_t node : nodes) EXPECT_FALSE(skin.faces_of_node[node].empty());
}

}  // namespace tact::model::fem::boundary_test
