// SPDX-License-Identifier: Apache-2.0
#include "model/contact/triangle_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "model/units.h"
#include "tests/support/brute_force.h"
#include "tests/support/no_alloc.h"
#include "tests/support/organs.h"

namespace tact::model::contact::triangle_tree_test {

constexpr double kAnywhere_m = std::numeric_limits<double>::infinity();

Vec3 random_unit(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return normalized(Vec3{uniform(random), uniform(random), uniform(random)});
}

TEST(TriangleTree, FindsWhatBruteForceFinds) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 3);
  const TriangleTree tree = make_triangle_tree(ball.view());
  const tests::BruteForce body(ball.vertex_m, ball.triangle);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = (50_mm + 40_mm * uniform(random)) * random_unit(random);
    const double truth_m = body.nearest(p, 1.0).distance_m;
    const auto near = static_cast<std::uint32_t>(random() % ball.triangle.size());
    for (const std::uint32_t start : {kNoTriangle, near})
      EXPECT_NEAR(
          std::abs(
              nearest_contact_point(tree.view(), ball.view(), p, kAnywhere_m, start).distance_m),
          truth_m, 1e-12);
    const ContactPoint within =
        nearest_contact_point(tree.view(), ball.view(), p, 5_mm, kNoTriangle);
    EXPECT_EQ(within.surface_point.triangle != kNoTriangle, truth_m < 5_mm);
    EXPECT_EQ(std::isinf(within.distance_m), truth_m >= 5_mm);
  }
}

TEST(TriangleTree, ThinClosedFlapHasTheRightSideEverywhere) {
  const mesh::SurfaceMesh flap = tests::make_flap(
      {.length_m = 60_mm, .width_m = 60_mm, .thickness_m = 0.2_mm, .edge_m = 5_mm});
  const TriangleTree tree = make_triangle_tree(flap.view());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> across(-40_mm, 40_mm), height(-0.4_mm, 0.2_mm);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p{across(random), across(random), height(random)};
    const bool is_inside =
        std::abs(p.x) < 30_mm && std::abs(p.y) < 30_mm && std::abs(p.z + 0.1_mm) < 0.1_mm;
    const ContactPoint contact_point =
        nearest_contact_point(tree.view(), flap.view(), p, kAnywhere_m, kNoTriangle);
    EXPECT_EQ(contact_point.distance_m < 0.0, is_inside) << p.x << ' ' << p.y << ' ' << p.z;
    inside += is_inside ? 1 : 0;
  }
  EXPECT_GT(inside, 500);
}

TEST(TriangleTree, BesideTheBoundaryOfAnOpenSurfaceIsOutside) {
  const mesh::SurfaceMesh plate = tests::make_plate(40_mm, 4);
  const TriangleTree tree = make_triangle_tree(plate.view());
  const auto distance_m = [&](const Vec3& p) {
    return nearest_contact_point(tree.view(), plate.view(), p, kAnywhere_m, kNoTriangle).distance_m;
  };
  EXPECT_NEAR(distance_m({5_mm, 3_mm, -7_mm}), -7_mm, 1e-12) << "behind the middle";
  EXPECT_NEAR(distance_m({23_mm, 0, -4_mm}), 5_mm, 1e-12) << "behind and beside";
}

TEST(TriangleTree, LeavesTheHeapAlone) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 3);
  const TriangleTree tree = make_triangle_tree(ball.view());
  const tests::NoAlloc guard;
  (void)nearest_contact_point(tree.view(), ball.view(), {0, 0, 52_mm}, kAnywhere_m, kNoTriangle);
  (void)nearest_contact_point(tree.view(), ball.view(), {0, 0, 0}, kAnywhere_m, kNoTriangle);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::contact::triangle_tree_test
