// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/organ/refine_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>

#include "tests/support/shapes.h"
#include "tools/program/interrupt.h"
#include "tools/program/run_program.h"
#include "tools/reference/self_check/block.h"

namespace tact::tools::reference::refine_surface_test {

using model::Vec3;

constexpr ground_truth::EdgeLengths kFine{
    .at_m = {0.0, 0.0, 0.0}, .axis = {}, .radius_m = 4e-3, .fine_m = 0.7e-3, .growth = 0.4};

Triangles block() {
  auto organ = make_block(0.05, 0.05, {});
  EXPECT_TRUE(organ) << organ.error().message;
  return {organ->surface.vertex_m, organ->surface.triangle};
}

/// Refined as asked; an error fails the test.
Triangles refined(Triangles coarse, const ground_truth::EdgeLengths& lengths) {
  auto fine = refine_surface(std::move(coarse), lengths);
  EXPECT_TRUE(fine) << fine.error().message;
  return std::move(*fine);
}

/// The surface of triangles that must be sound; an error fails the test.
model::mesh::SurfaceMesh sound(const Triangles& t) {
  auto surface = model::mesh::make_surface_mesh(t.vertex_m, t.triangle);
  EXPECT_TRUE(surface) << surface.error().message;
  return std::move(*surface);
}

double least_angle_rad(const Triangles& s) {
  double least = 10.0;
  for (const auto& t : s.triangle) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = s.vertex_m[t[(k + 1) % 3]] - s.vertex_m[t[k]];
      const Vec3 b = s.vertex_m[t[(k + 2) % 3]] - s.vertex_m[t[k]];
      least = std::min(least, std::acos(dot(a, b) / (norm(a) * norm(b))));
    }
  }
  return least;
}

TEST(RefineSurface, KeepsTheSurfaceClosedAndItsVolume) {
  const Triangles coarse = block();
  const Triangles fine = refined(coarse, kFine);
  const auto before = model::mesh::summarize(sound(coarse)),
             after = model::mesh::summarize(sound(fine));
  EXPECT_EQ(after.boundary_edges, 0U);
  EXPECT_NEAR(after.volume_m3, before.volume_m3, 1e-12 * before.volume_m3);
  EXPECT_NEAR(after.area_m2, before.area_m2, 1e-12 * before.area_m2);
  EXPECT_GT(after.triangles, before.triangles);
}

TEST(RefineSurface, KeepsTheNumbersOfOldVertices) {
  const Triangles coarse = block();
  const Triangles fine = refined(coarse, kFine);
  for (std::size_t i = 0; i < coarse.vertex_m.size(); ++i)
    EXPECT_EQ(fine.vertex_m[i], coarse.vertex_m[i]);
}

TEST(RefineSurface, LeavesNoEdgeLongerThanAsked) {
  const Triangles fine = refined(block(), kFine);
  for (const auto& t : fine.triangle) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &p = fine.vertex_m[t[k]], &q = fine.vertex_m[t[(k + 1) % 3]];
      // An edge that is not the longest of its triangle is judged by that one: nearly the same h.
      EXPECT_LE(norm(p - q), 1.2 * kFine.at(0.5 * (p + q)) + 1e-12);
    }
  }
}

TEST(RefineSurface, KeepsAnglesAboveHalfOfTheSmallest) {
  const Triangles coarse = block();
  EXPECT_GE(least_angle_rad(refined(coarse, kFine)), 0.5 * least_angle_rad(coarse) - 1e-9);
}

TEST(RefineSurface, RefusesEdgesThatCannotBeReached) {
  // In order: no length, none, too small for numbers, too many triangles.
  const double nan = std::nan("");
  for (const auto& [radius_m, fine_m] :
       {std::pair{4e-3, nan}, {4e-3, 0.0}, {0.0, 1e-30}, {4e-3, 1e-6}}) {
    ground_truth::EdgeLengths none = kFine;
    none.radius_m = radius_m;
    none.fine_m = fine_m;
    const auto endless = refine_surface(block(), none);
    ASSERT_FALSE(endless) << fine_m;
    EXPECT_NE(endless.error().message.find("ask for a larger depth"), std::string::npos);
  }
}

TEST(RefineSurface, StopsAtCtrlC) {
  const program::InterruptFlag watch;
  std::raise(SIGINT);
  const auto fine = refine_surface(block(), kFine);
  ASSERT_FALSE(fine);
  EXPECT_TRUE(program::was_interrupted(fine.error()));
}

TEST(RefineSurface, FollowsACircleToo) {
  ground_truth::EdgeLengths ring = kFine;
  ring.axis = {0.0, 0.0, 1.0};
  EXPECT_DOUBLE_EQ(ring.at({4e-3, 0.0, 0.0}), 0.7e-3);
  EXPECT_DOUBLE_EQ(ring.at({0.0, 0.0, 0.0}), 0.7e-3 + 0.4 * 4e-3);
  EXPECT_DOUBLE_EQ(ring.at({0.0, 4e-3, 3e-3}), 0.7e-3 + 0.4 * 3e-3);
  EXPECT_DOUBLE_EQ(kFine.at({0.0, 0.0, 3e-3}), 0.7e-3);
  EXPECT_DOUBLE_EQ(kFine.at({0.0, 0.0, 5e-3}), 0.7e-3 + 0.4 * 1e-3);
}

TEST(CutAlong, PutsEveryTriangleInsideOrOutsideOfTheCircle) {
  const Circle circle{.at_m = {0.0, 0.0, 0.0}, .axis = {0.0, 0.0, -1.0}, .radius_m = 4e-3};
  const Triangles coarse = refined(block(), kFine);
  const Triangles cut = cut_along(coarse, circle, 8e-3);
  const auto before = model::mesh::summarize(sound(coarse)),
             after = model::mesh::summarize(sound(cut));
  EXPECT_EQ(after.boundary_edges, 0U);
  EXPECT_NEAR(after.volume_m3, before.volume_m3, 1e-12 * before.volume_m3);
  double inside_m2 = 0.0;
  for (const auto& t : cut.triangle) {
    const Vec3 &a = cut.vertex_m[t[0]], &b = cut.vertex_m[t[1]], &c = cut.vertex_m[t[2]];
    if (norm((a + b + c) / 3.0) < circle.radius_m) inside_m2 += 0.5 * norm(cross(b - a, c - a));
  }
  // Without the cut the triangles of 0.7 mm leave a ragged edge; with it the area is the disc's.
  EXPECT_NEAR(inside_m2, M_PI * 16e-6, 0.01 * M_PI * 16e-6);
}

}  // namespace tact::tools::reference::refine_surface_test
