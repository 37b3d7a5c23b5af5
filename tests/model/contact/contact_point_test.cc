// SPDX-License-Identifier: Apache-2.0
#include "model/contact/contact_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model/units.h"
#include "tests/support/shapes.h"

namespace tact::model::contact::site_test {

TEST(ContactPoint, MeasuresTheHeightOverAPlate) {
  const mesh::SurfaceMesh plate = tests::make_plate(100_mm, 10);
  const ContactPoint above = follow(plate.view(), 0, {13_mm, -7_mm, 5_mm});
  EXPECT_NEAR(above.distance_m, 5_mm, 1e-15);
  EXPECT_NEAR(above.normal.z, 1.0, 1e-12);
  const ContactPoint below = follow(plate.view(), 0, {13_mm, -7_mm, -5_mm});
  EXPECT_NEAR(below.distance_m, -5_mm, 1e-15);
  EXPECT_NEAR(below.normal.z, 1.0, 1e-12) << "the gradient points outward on both sides";
}

TEST(ContactPoint, NormalIsTheGradientOfTheDistance) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 3);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = (45_mm + 10_mm * std::abs(uniform(random))) *
                   normalized(Vec3{uniform(random), uniform(random), uniform(random)});
    const ContactPoint here = follow(ball.view(), 0, p);
    const double h = 1e-7;
    const auto slope = [&](const Vec3& e) {
      return (follow(ball.view(), here.surface_point.triangle, p + h * e).distance_m -
              follow(ball.view(), here.surface_point.triangle, p - h * e).distance_m) /
             (2 * h);
    };
    const Vec3 gradient{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
    if (std::abs(norm(gradient) - 1.0) > 1e-3) continue;  // on the seam of two facets, from inside
    EXPECT_NEAR(norm(gradient - here.normal), 0.0, 1e-4);
  }
}

TEST(ContactPoint, WeightsOfItsCornersGiveItsPoint) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 2);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int corners_that_count[4] = {};
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = (40_mm + 30_mm * std::abs(uniform(random))) *
                   normalized(Vec3{uniform(random), uniform(random), uniform(random)});
    const ContactPoint contact_point = follow(ball.view(), 0, p);
    Vec3 point_m{};
    int counts = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      point_m += contact_point.surface_point.weight[c] *
                 ball.vertex_m[ball.triangle[contact_point.surface_point.triangle][c]];
      counts += contact_point.surface_point.weight[c] != 0.0;
    }
    EXPECT_NEAR(norm(point_m - contact_point.point_m), 0.0, 1e-12);
    ++corners_that_count[counts];
  }
  for (int counts = 1; counts <= 3; ++counts)
    EXPECT_GT(corners_that_count[counts], 10) << "vertices, edges and faces are met";
}

TEST(ContactPoint, AShortMoveIsFollowedOverAFineSurface) {
  const mesh::SurfaceMesh ball = tests::make_ball(50_mm, 6);  // 32 768 triangles of about 1.5 mm
  std::uint32_t triangle = follow(ball.view(), 0, {51_mm, 0, 0}).surface_point.triangle;
  for (int step = 0; step <= 2000; ++step) {  // 0.1 mm a tick round the equator and over the pole
    const double angle_rad = step * 0.1_mm / 51_mm;
    const Vec3 p =
        51_mm * Vec3{std::cos(angle_rad), std::sin(angle_rad) * 0.6, std::sin(angle_rad) * 0.8};
    const ContactPoint contact_point = follow(ball.view(), triangle, p);
    EXPECT_NEAR(contact_point.distance_m, 1_mm, 0.02_mm);
    triangle = contact_point.surface_point.triangle;
  }
}

TEST(ContactPoint, PressingIntoAThinPlateDoesNotJumpToItsFarSide) {
  // Two sheets 4 mm apart: followed from above, a probe 3 mm deep is still under the upper one.
  mesh::SurfaceMesh upper = tests::make_plate(40_mm, 8), lower = tests::make_plate(40_mm, 8);
  std::vector<Vec3> v = upper.vertex_m;
  std::vector<TriangleCorners> t = upper.triangle;
  const auto shift = static_cast<std::uint32_t>(v.size());
  for (const Vec3& p : lower.vertex_m) v.push_back(p - Vec3{0, 0, 4_mm});
  for (const auto& [a, b, c] : lower.triangle) t.push_back({a + shift, c + shift, b + shift});
  const mesh::SurfaceMesh sheets = *mesh::make_surface_mesh(v, t);
  std::uint32_t triangle = 0;
  for (double z = 1_mm; z > -3_mm; z -= 0.1_mm)
    triangle = follow(sheets.view(), triangle, {1_mm, 1_mm, z}).surface_point.triangle;
  EXPECT_NEAR(follow(sheets.view(), triangle, {1_mm, 1_mm, -3_mm}).distance_m, -3_mm, 1e-9);
}

}  // namespace tact::model::contact::site_test
