// SPDX-License-Identifier: Apache-2.0
// The reference for contact, against shapes known on paper, and its grid against plain loops.
#include "tests/support/brute_force.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/organs.h"

namespace tact::model::contact::brute_force_test {

using tests::BruteForce;

BruteForce reference(const mesh::SurfaceMesh& mesh) { return {mesh.vertex_m, mesh.triangle}; }

void expect_point(const BruteForce& body, const Vec3& p_m, double distance_m, double winding,
                  double within_m = 1e-9) {
  SCOPED_TRACE(testing::Message() << p_m.x << " " << p_m.y << " " << p_m.z);
  EXPECT_NEAR(body.nearest_by_loop(p_m).distance_m, distance_m, within_m);
  EXPECT_NEAR(body.nearest(p_m, 1.0).distance_m, distance_m, within_m);
  EXPECT_NEAR(body.winding_by_loop(p_m), winding, 1e-9);
  EXPECT_NEAR(body.winding(p_m), winding, 1e-9);
}

TEST(BruteForce, KnowsABox) {
  const BruteForce box = reference(tests::make_flap(
      {.length_m = 40_mm, .width_m = 30_mm, .thickness_m = 20_mm, .edge_m = 10_mm}));
  EXPECT_TRUE(box.is_closed());
  expect_point(box, {1_mm, 2_mm, -7_mm}, 7_mm, 1);
  expect_point(box, {1_mm, 2_mm, 3_mm}, 3_mm, 0);
  expect_point(box, {23_mm, 19_mm, -5_mm}, 5_mm, 0);  // an edge: 3, 4
  expect_point(box, {21_mm, 17_mm, 2_mm}, 3_mm, 0);   // a corner: 1, 2, 2
  EXPECT_TRUE(box.crosses({1_mm, 2_mm, 5_mm}, {1_mm, 2_mm, -5_mm}));
  EXPECT_TRUE(box.crosses({1_mm, 2_mm, 5_mm}, {1_mm, 2_mm, -50_mm}));
  EXPECT_FALSE(box.crosses({1_mm, 2_mm, -1_mm}, {5_mm, 2_mm, -19_mm}));
  EXPECT_FALSE(box.crosses({21_mm, 2_mm, 1_mm}, {21_mm, 2_mm, -50_mm}));
}

TEST(BruteForce, KnowsABallAndATorus) {
  const BruteForce ball = reference(tests::make_ball(30_mm, 5));
  expect_point(ball, {0, 0, 0}, 30_mm, 1, 0.05_mm);
  expect_point(ball, {28_mm, 1_mm, 0.5_mm}, 30_mm - std::hypot(28_mm, 1_mm, 0.5_mm), 1, 0.05_mm);
  expect_point(ball, {10_mm, 20_mm, 30_mm}, std::hypot(10_mm, 20_mm, 30_mm) - 30_mm, 0, 0.05_mm);
  const BruteForce torus = reference(tests::make_torus(25_mm, 8_mm, 90, 45));
  EXPECT_TRUE(torus.is_closed());
  expect_point(torus, {0, 0, 0.1_mm}, 17_mm, 0, 0.05_mm);
  expect_point(torus, {25_mm, 0.3_mm, 0.2_mm}, 7.8_mm, 1, 0.05_mm);
  expect_point(torus, {0, 25_mm, 11_mm}, 3_mm, 0, 0.05_mm);
  EXPECT_FALSE(torus.crosses({0, 0, 30_mm}, {0, 0, -30_mm}));
  EXPECT_TRUE(torus.crosses({25_mm, 0.1_mm, 30_mm}, {25_mm, 0.1_mm, -30_mm}));
}

TEST(BruteForce, ABladderIsHollow) {
  const BruteForce bladder = reference(tests::make_bladder({30_mm, 25_mm, 20_mm}, 4_mm, 4));
  EXPECT_TRUE(bladder.is_closed());
  EXPECT_NEAR(bladder.winding({0.1_mm, 0, 0}), 0, 1e-9);
  EXPECT_NEAR(bladder.winding_by_loop({0.1_mm, 0, 0}), 0, 1e-9);
  EXPECT_NEAR(bladder.winding({28_mm, 0.1_mm, 0}), 1, 1e-9);
  EXPECT_NEAR(bladder.winding_by_loop({0, 0.1_mm, 18_mm}), 1, 1e-9);
  EXPECT_NEAR(bladder.winding({0, 0, 21_mm}), 0, 1e-9);
}

TEST(BruteForce, AnOpenPlateIsHalfASideAway) {
  const mesh::SurfaceMesh mesh = tests::make_plate(100_mm, 20);
  const BruteForce plate = reference(mesh);
  EXPECT_FALSE(plate.is_closed());
  // Close to it: all but half of the full solid angle, above and below.
  EXPECT_NEAR(plate.winding_by_loop({1.1_mm, 2.2_mm, 0.01_mm}), -0.5, 1e-3);
  EXPECT_NEAR(plate.winding_by_loop({1.1_mm, 2.2_mm, -0.01_mm}), 0.5, 1e-3);
  EXPECT_NEAR(plate.winding({1.1_mm, 2.2_mm, -0.01_mm}), 0.5, 1e-3);
}

void expect_grid_as_loops(const mesh::SurfaceMesh& mesh, int points) {
  const BruteForce body = reference(mesh);
  std::mt19937 random(3);
  const auto from = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto point = [&] {
    const Vec3 &a = body.low_m(), &b = body.high_m();
    const double margin_m = 10_mm;
    return Vec3{from(a.x - margin_m, b.x + margin_m), from(a.y - margin_m, b.y + margin_m),
                from(a.z - margin_m, b.z + margin_m)};
  };
  for (int i = 0; i < points; ++i) {
    const Vec3 p_m = point(), q_m = p_m + 0.3 * (point() - p_m);
    const BruteForce::Nearest loop = body.nearest_by_loop(p_m);
    const double found_m = body.nearest(p_m, 8_mm).distance_m;
    if (loop.distance_m < 8_mm)
      EXPECT_NEAR(found_m, loop.distance_m, 1e-12);
    else
      EXPECT_TRUE(std::isinf(found_m));
    EXPECT_NEAR(body.winding(p_m), body.winding_by_loop(p_m), 1e-6);
    EXPECT_EQ(body.crosses(p_m, q_m), body.crosses_by_loop(p_m, q_m));
  }
}

TEST(BruteForce, GridSearchGivesTheDistanceOfTheFullLoop) {
  expect_grid_as_loops(tests::make_plate(100_mm, 20), 500);
  expect_grid_as_loops(tests::make_torus(25_mm, 8_mm, 60, 30), 500);
  expect_grid_as_loops(tests::make_bladder({30_mm, 25_mm, 20_mm}, 4_mm, 3), 500);
  for (const double bend_m : {0.0, 25_mm})
    expect_grid_as_loops(tests::make_flap({.length_m = 60_mm,
                                           .width_m = 40_mm,
                                           .thickness_m = 2_mm,
                                           .edge_m = 3_mm,
                                           .bend_radius_m = bend_m}),
                         500);
  expect_grid_as_loops(tests::make_flap({.length_m = 90_mm,
                                         .width_m = 30_mm,
                                         .thickness_m = 4_mm,
                                         .edge_m = 1.5_mm,
                                         .gap_m = 5_mm}),
                       500);
}

}  // namespace tact::model::contact::brute_force_test
