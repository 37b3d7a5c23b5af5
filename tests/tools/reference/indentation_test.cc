// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/indentation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/needs_calculix.h"
#include "tests/support/shapes.h"
#include "tools/reference/press/half_space.h"
#include "tools/reference/self_check/block.h"

namespace tact::tools::reference::indentation_test {

using model::Vec3;

/// Six-node faces over a plate, enough for ring_means.
OrganBody plate_body() {
  const model::mesh::SurfaceMesh plate = tests::make_plate(0.08, 40);
  OrganBody body{
      .mesh = {plate.vertex_m, {}}, .face = {}, .normal = plate.face_normal, .held_node = {}};
  for (const auto& t : plate.triangle) {
    FaceNodes nodes{t[0], t[1], t[2], 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      nodes[3 + k] = static_cast<std::uint32_t>(body.mesh.node_m.size());
      body.mesh.node_m.push_back(0.5 * (plate.vertex_m[t[k]] + plate.vertex_m[t[(k + 1) % 3]]));
    }
    body.face.push_back(nodes);
  }
  return body;
}

TEST(RingMeans, OfAConeAreItsHeights) {
  const OrganBody body = plate_body();
  std::vector<double> u;
  for (const Vec3& p : body.mesh.node_m) u.push_back(1.0 - norm(p) / 0.04 + 5.0 * p.x);
  const auto rings = ring_means(body, {0, 0, 0}, {0, 0, 1}, u, 1.0);
  ASSERT_EQ(rings.size(), 31U);
  EXPECT_EQ(rings[0], 1.0);
  // The tilt 5 x averages out round each ring.
  for (std::size_t k = 1; k < 31; ++k)
    EXPECT_NEAR(rings[k], 1.0 - static_cast<double>(k) / 40.0, 2e-3) << k;
}

TEST(RingMeans, DoNotSeeTheFarSide) {
  OrganBody body = plate_body();
  const std::size_t faces = body.face.size();
  std::vector<double> u(body.mesh.node_m.size(), 1.0);
  for (std::size_t f = 0; f < faces; ++f) {  // the same plate 2 mm below, looking down
    FaceNodes other{};
    for (std::size_t k = 0; k < 6; ++k) {
      other[k] = static_cast<std::uint32_t>(body.mesh.node_m.size());
      body.mesh.node_m.push_back(body.mesh.node_m[body.face[f][k]] - Vec3{0, 0, 2e-3});
      u.push_back(-100.0);
    }
    body.face.push_back(other);
    body.normal.push_back({0, 0, -1});
  }
  for (const double mean : ring_means(body, {0, 0, 0}, {0, 0, 1}, u, 1.0))
    EXPECT_NEAR(mean, 1.0, 1e-12);
}

TEST(Indentation, APullWithLargeStrainHasEdgesItCanDrawOut) {
  const auto block = make_block(0.05, 0.05, {.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45});
  ASSERT_TRUE(block) << block.error().message;
  const auto fine_m = [&](double depth_m, bool large_strain, int level) {
    return edge_lengths(*block, {.vertex = 0,
                                 .tool_radius_m = 5e-3,
                                 .depth_m = depth_m,
                                 .large_strain = large_strain,
                                 .level = level})
        .fine_m;
  };
  EXPECT_DOUBLE_EQ(fine_m(-6.5e-3, false, kCoarsestLevel), 0.12 * 5e-3) << "linear: any depth";
  EXPECT_DOUBLE_EQ(fine_m(-1e-3, true, kCoarsestLevel), 0.12 * 5e-3);
  EXPECT_DOUBLE_EQ(fine_m(-6.5e-3, true, kCoarsestLevel), 6.5e-3 / 8.0);
  EXPECT_NEAR(fine_m(-6.5e-3, true, kRoughLevel), 6.5e-3 / 8.0 / 0.7, 0.02e-3)
      << "coarser, so that the error can be told";
  EXPECT_GT(fine_m(5e-3, true, kRoughLevel), 1.3 * fine_m(5e-3, true, kCoarsestLevel));
}

using SolvedIndentation = tests::NeedsCalculiX;

TEST_F(SolvedIndentation, OfABlockIsThatOfAnIndependentSolution) {
  // Round block 50 x 50 mm, E = 1 kPa, nu = 0.45, sphere R = 5 mm: 40.46 mN at 5 mm (FEniCS).
  const auto block = make_block(0.05, 0.05, {.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45});
  ASSERT_TRUE(block) << block.error().message;
  const auto solved =
      solve(*block, {.vertex = 0, .tool_radius_m = 5e-3, .depth_m = 5e-3, .level = kCoarsestLevel});
  ASSERT_TRUE(solved) << solved.error().message;
  EXPECT_NEAR(solved->force_N, 40.46e-3, 0.025 * 40.46e-3);
  EXPECT_GT(solved->force_N, 1.03 * sphere_force_N(block->material, 5e-3, 5e-3))
      << "the held bottom is felt";
  EXPECT_NEAR(solved->profile_m[0], 5e-3, 1e-9);
  // Under the tip the tissue has the sphere's shape.
  EXPECT_NEAR(solved->profile_m[3], 5e-3 - (5e-3 - 4e-3), 0.03e-3);
}

}  // namespace tact::tools::reference::indentation_test
