// SPDX-License-Identifier: Apache-2.0
#include "model/contact/site.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model/contact/contact.h"
#include "model/contact/seed_grid.h"
#include "model/units.h"
#include "tests/support/no_alloc.h"
#include "tests/support/shapes.h"
#include "tests/support/soft_half_space.h"

namespace tact::model::contact::site_test {

// The same question asked of every triangle.
double nearest_by_brute_force_m(const SurfaceView& surface, const Vec3& p) {
  double best_m = 1e300;
  for (std::uint32_t t = 0; t < surface.triangle.size(); ++t) {
    mesh::SurfaceMesh one;  // a mesh of a single triangle cannot be walked away from
    for (const std::uint32_t v : surface.triangle[t]) one.vertex_m.push_back(surface.vertex_m[v]);
    one.triangle = {{0, 1, 2}};
    one.neighbour = {{kNoTriangle, kNoTriangle, kNoTriangle}};
    one.face_normal = {surface.face_normal[t]};
    one.vertex_normal.assign(3, surface.face_normal[t]);
    one.fan_start = {0, 1, 2, 3};
    one.fan = {0, 0, 0};
    mesh::fill_records(one);
    best_m = std::min(best_m, std::abs(follow(one.view(), 0, p).distance_m));
  }
  return best_m;
}

Site query(const SurfaceView& surface, const SeedGridView& seeds, const Vec3& p) {
  Site best;
  for (const std::uint32_t seed : seeds.cell[seeds.cell_of(p)]) {
    if (seed == kNoTriangle) continue;
    const Site site = follow(surface, seed, p);
    if (best.place.triangle == kNoTriangle || std::abs(site.distance_m) < std::abs(best.distance_m))
      best = site;
  }
  return best;
}

TEST(Site, MeasuresTheHeightOverAPlate) {
  const mesh::SurfaceMesh plate = tests::make_plate(100_mm, 10);
  const Site above = follow(plate.view(), 0, {13_mm, -7_mm, 5_mm});
  EXPECT_NEAR(above.distance_m, 5_mm, 1e-15);
  EXPECT_NEAR(above.normal.z, 1.0, 1e-12);
  const Site below = follow(plate.view(), 0, {13_mm, -7_mm, -5_mm});
  EXPECT_NEAR(below.distance_m, -5_mm, 1e-15);
  EXPECT_NEAR(below.normal.z, 1.0, 1e-12) << "the gradient points outward on both sides";
}

TEST(Site, NormalIsTheGradientOfTheDistance) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 3);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = (45_mm + 10_mm * std::abs(uniform(random))) *
                   normalized(Vec3{uniform(random), uniform(random), uniform(random)});
    const Site here = follow(ball.view(), 0, p);
    const double h = 1e-7;
    const auto slope = [&](const Vec3& e) {
      return (follow(ball.view(), here.place.triangle, p + h * e).distance_m -
              follow(ball.view(), here.place.triangle, p - h * e).distance_m) /
             (2 * h);
    };
    const Vec3 gradient{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
    if (std::abs(norm(gradient) - 1.0) > 1e-3) continue;  // on the seam of two facets, from inside
    EXPECT_NEAR(norm(gradient - here.normal), 0.0, 1e-4);
  }
}

TEST(Site, WeightsOfItsCornersGiveItsPoint) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 2);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int corners_that_count[4] = {};
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = (40_mm + 30_mm * std::abs(uniform(random))) *
                   normalized(Vec3{uniform(random), uniform(random), uniform(random)});
    const Site site = follow(ball.view(), 0, p);
    Vec3 point_m{};
    int counts = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      point_m += site.place.weight[c] * ball.vertex_m[ball.triangle[site.place.triangle][c]];
      counts += site.place.weight[c] != 0.0;
    }
    EXPECT_NEAR(norm(point_m - site.point_m), 0.0, 1e-12);
    ++corners_that_count[counts];
  }
  for (int counts = 1; counts <= 3; ++counts)
    EXPECT_GT(corners_that_count[counts], 10) << "vertices, edges and faces are met";
}

TEST(Site, GlobalQueryFindsWhatBruteForceFinds) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 3);
  const SeedGrid seeds = make_seed_grid(ball.view(), 20_mm);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = (50_mm + 15_mm * uniform(random)) *
                   normalized(Vec3{uniform(random), uniform(random), uniform(random)});
    const double truth_m = nearest_by_brute_force_m(ball.view(), p);
    EXPECT_NEAR(std::abs(query(ball.view(), seeds.view(), p).distance_m), truth_m, 1e-12);
  }
}

TEST(Site, AfterTheStepsThatItMayTakeAWalkIsOnlyAsNearAsItCame) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 6);
  const Vec3 p{0, 0, 60_mm};
  const std::uint32_t start = follow(ball.view(), 0, {0.5_mm, 8_mm, 49_mm}).place.triangle;
  double before_m = follow(ball.view(), start, p, 0).distance_m;
  for (int steps = 1; steps <= 4; ++steps) {
    const double now_m = follow(ball.view(), start, p, steps).distance_m;
    EXPECT_LT(now_m, before_m);
    before_m = now_m;
  }
  EXPECT_GT(before_m, follow(ball.view(), start, p).distance_m);
}

// A free sphere keeps what it has walked from cell to cell, and walks slowly far away.
TEST(Site, NearASurfaceAFreeSphereIsAsFarAwayAsBruteForceFinds) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 5);
  const SeedGrid seeds = make_seed_grid(ball.view(), 20_mm);
  tests::SoftHalfSpace tissue;
  const ProbeSphere sphere{{}, 4_mm};
  Contact contact({.law = &tissue.field,
                   .parameters = {},
                   .spheres = {&sphere, 1},
                   .surface = ball.view(),
                   .seeds = seeds.view(),
                   .blade = {}});
  int near = 0;
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.01 * i, height_m = 54_mm + 30_mm * (1.0 + std::sin(1.7 * t));
    const Vec3 p = height_m * normalized(Vec3{std::sin(t), std::cos(1.3 * t), std::sin(0.7 * t)});
    contact.touch({.position_m = p});
    contact.feel({.position_m = p}, false);
    const SphereTouch& touch = contact.touches()[0];
    if (touch.state != TouchState::kFree || height_m > 60_mm) continue;
    EXPECT_NEAR(norm(p - touch.surface_point_m), nearest_by_brute_force_m(ball.view(), p), 1e-12);
    ++near;
  }
  EXPECT_GT(near, 500);
}

TEST(Site, AShortMoveIsFollowedOverAFineSurface) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 6);  // 32 768 triangles of about 1.5 mm
  std::uint32_t triangle = follow(ball.view(), 0, {51_mm, 0, 0}).place.triangle;
  for (int step = 0; step <= 2000; ++step) {  // 0.1 mm a tick round the equator and over the pole
    const double angle_rad = step * 0.1_mm / 51_mm;
    const Vec3 p =
        51_mm * Vec3{std::cos(angle_rad), std::sin(angle_rad) * 0.6, std::sin(angle_rad) * 0.8};
    const Site site = follow(ball.view(), triangle, p);
    EXPECT_NEAR(site.distance_m, 1_mm, 0.02_mm);
    triangle = site.place.triangle;
  }
}

TEST(Site, PressingIntoAThinPlateDoesNotJumpToItsFarSide) {
  // Two sheets 4 mm apart: followed from above, a probe 3 mm deep is still under the upper one.
  mesh::SurfaceMesh upper = tests::make_plate(40_mm, 8), lower = tests::make_plate(40_mm, 8);
  std::vector<Vec3> v = upper.vertex_m;
  std::vector<TriangleCorners> t = upper.triangle;
  const auto shift = static_cast<std::uint32_t>(v.size());
  for (const Vec3& p : lower.vertex_m) v.push_back(p - Vec3{0, 0, 4_mm});
  for (const auto& [a, b, c] : lower.triangle) t.push_back({a + shift, c + shift, b + shift});
  const mesh::SurfaceMesh sheets = *mesh::make_surface_mesh(v, t);
  const SeedGrid seeds = make_seed_grid(sheets.view(), 5_mm);
  std::uint32_t triangle = query(sheets.view(), seeds.view(), {1_mm, 1_mm, 1_mm}).place.triangle;
  for (double z = 1_mm; z > -3_mm; z -= 0.1_mm)
    triangle = follow(sheets.view(), triangle, {1_mm, 1_mm, z}).place.triangle;
  EXPECT_NEAR(follow(sheets.view(), triangle, {1_mm, 1_mm, -3_mm}).distance_m, -3_mm, 1e-9);
  // And each sheet is found from its own side.
  EXPECT_NEAR(query(sheets.view(), seeds.view(), {1_mm, 1_mm, -5_mm}).distance_m, 1_mm, 1e-9);
}

TEST(Site, LeavesTheHeapAlone) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 3);
  const SeedGrid seeds = make_seed_grid(ball.view(), 20_mm);
  const tests::NoAlloc guard;
  (void)query(ball.view(), seeds.view(), {0, 0, 52_mm});
  EXPECT_EQ(guard.calls(), 0u);
}

TEST(SeedGrid, PutsEveryPointIntoACell) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 3);
  const SeedGrid seeds = make_seed_grid(ball.view(), 20_mm);
  for (const Vec3& p :
       {Vec3{0, 0, 0}, Vec3{10, 10, 10}, Vec3{-10, 0, 0}, Vec3{std::nan(""), 0, 0}}) {
    const std::uint32_t cell = seeds.view().cell_of(p);
    ASSERT_LT(cell, seeds.cell.size());
    EXPECT_NE(seeds.cell[cell][0], kNoTriangle);
  }
}

}  // namespace tact::model::contact::site_test
