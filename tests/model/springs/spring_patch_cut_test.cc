// SPDX-License-Identifier: Apache-2.0
// Cutting a spring patch: what is removed, what opens, what is reported, and where the energy goes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "tests/model/springs/patch_fixture.h"

namespace tact::model::springs::spring_patch_cut_test {

using tests::PressedPatch;
using tests::soft_patch;

/// An upright blade drawn along x at y, through the surface.
contact::BladeSweep stroke(double from_x_m, double to_x_m, double y_m) {
  return {.from_a_m = {from_x_m, y_m, -0.01},
          .from_b_m = {from_x_m, y_m, 0.01},
          .to_a_m = {to_x_m, y_m, -0.01},
          .to_b_m = {to_x_m, y_m, 0.01}};
}

SpringPatchParameters stretched() {
  SpringPatchParameters p = soft_patch();
  p.tissue.pretension_ratio = 0.15;
  return p;
}

/// Touched in the middle for long enough to have settled.
void settle(PressedPatch& pressed, double depth_m, int ticks = 800) {
  for (int i = 0; i < ticks; ++i) {
    pressed.move_to(0.001, 0.0024, depth_m);
    pressed.advance();
  }
}

TEST(SpringPatchCut, RemovesTheSpringsOnItsWayAndListsTheirTriangles) {
  PressedPatch pressed(soft_patch());
  settle(pressed, 1e-6, 1);
  const std::size_t before = pressed.patch().region().spring_count();
  pressed.patch().cut(stroke(-0.0201, 0.0199, 0.0024));
  // Row of 5 mm squares, 40 mm long: 8 verticals and 8 diagonals.
  EXPECT_EQ(before - pressed.patch().region().spring_count(), 16u);
  // one triangle more than edges crossed, in a strip
  const auto cut = pressed.patch().region().cut_triangles();
  EXPECT_EQ(cut.size(), 17u);
  EXPECT_EQ(std::set<std::uint32_t>(cut.begin(), cut.end()).size(), cut.size());
  pressed.patch().cut(stroke(-0.0201, 0.0199, 0.0024));
  EXPECT_EQ(pressed.patch().region().cut_triangles().size(), 17u) << "twice is once";
}

TEST(SpringPatchCut, OnlyRemovesStoredEnergy) {
  PressedPatch pressed(stretched());
  settle(pressed, 0.003);
  for (int i = 0; i < 20; ++i) {
    const double before_J = pressed.patch().stored_energy_J();
    const double moving_J = pressed.patch().kinetic_energy_J();
    const std::size_t springs = pressed.patch().region().spring_count();
    pressed.patch().cut(stroke(-0.02 + 0.002 * i, -0.018 + 0.002 * i, 0.0024));
    EXPECT_LE(pressed.patch().stored_energy_J(), before_J);
    if (pressed.patch().region().spring_count() < springs)
      EXPECT_LT(pressed.patch().stored_energy_J(), before_J);
    EXPECT_EQ(pressed.patch().kinetic_energy_J(), moving_J);
    settle(pressed, 0.003, 5);
  }
  // what is stored falls further by itself, and nothing comes back
  const double after_J = pressed.patch().stored_energy_J() + pressed.patch().kinetic_energy_J();
  settle(pressed, 0.003);
  EXPECT_LT(pressed.patch().stored_energy_J() + pressed.patch().kinetic_energy_J(), after_J);
}

TEST(SpringPatchCut, PretensionPullsTheLipsApart) {
  const auto gap_m = [](const SpringPatchParameters& p) {
    PressedPatch pressed(p);
    settle(pressed, 1e-6, 1);
    pressed.patch().cut(stroke(-0.0201, 0.0199, 0.0024));
    pressed.patch().leave(0);
    pressed.advance(800);
    // vertices of the rows y = 0 and y = 5 mm at x = 0
    const auto& mesh = pressed.mesh();
    double low_m = 0.0, high_m = 0.0;
    for (std::uint32_t v = 0; v < mesh.vertex_m.size(); ++v) {
      if (norm(mesh.vertex_m[v]) < 1e-9) low_m = pressed.patch().region().moved_m(v).y;
      if (norm(mesh.vertex_m[v] - Vec3{0, 0.005, 0}) < 1e-9)
        high_m = pressed.patch().region().moved_m(v).y;
    }
    return high_m - low_m;
  };
  EXPECT_GT(gap_m(stretched()), 0.0005);
  EXPECT_NEAR(gap_m(soft_patch()), 0.0, 1e-12);
}

TEST(SpringPatchCut, CutPatchIsSofter) {
  const auto force_N = [](bool cut) {
    PressedPatch pressed(stretched());
    settle(pressed, 1e-6, 1);
    if (cut) pressed.patch().cut(stroke(-0.03, 0.03, 0.0024));
    settle(pressed, 0.003);
    return pressed.move_to(0.001, 0.0024, 0.003).law.force_N;
  };
  EXPECT_LT(force_N(true), 0.9 * force_N(false));
}

TEST(SpringPatchCut, StaysOpenWhenTheToolGoesElsewhere) {
  SpringPatchParameters p = stretched();
  p.nodes = 80;
  PressedPatch pressed(p);
  settle(pressed, 1e-6, 1);
  pressed.patch().cut(stroke(-0.0101, 0.0099, 0.0024));
  settle(pressed, 1e-6);
  std::vector<Vec3> open_m;
  const std::vector<std::uint32_t> cut_edges(pressed.patch().region().cut_edges().begin(),
                                             pressed.patch().region().cut_edges().end());
  open_m.reserve(cut_edges.size());
  for (const std::uint32_t v : cut_edges) open_m.push_back(pressed.patch().region().moved_m(v));
  for (int i = 0; i <= 400; ++i) {
    pressed.move_to(0.0001 * i, -0.0001 * i, 1e-6);
    pressed.advance();
  }
  std::size_t left = 0;
  for (std::size_t i = 0; i < cut_edges.size(); ++i) {
    if (pressed.patch().region().slot_of(cut_edges[i]) != kNoSlot) continue;
    ++left;
    const Vec3 now_m = pressed.patch().region().moved_m(cut_edges[i]);
    if (norm(open_m[i]) < 1e-4) continue;
    EXPECT_GT(dot(now_m, open_m[i]), 0.5 * dot(open_m[i], open_m[i])) << "edge " << i;
  }
  EXPECT_GT(left, 4u);
  contact::PatchShape shape;
  EXPECT_TRUE(pressed.patch().shape(shape));
  const auto last = shape.vertex.begin() + shape.node_count;
  for (std::size_t i = 0; i < cut_edges.size(); ++i) {
    if (norm(open_m[i]) < 1e-4) continue;
    EXPECT_NE(std::find(shape.vertex.begin(), last, cut_edges[i]), last)
        << "the viewer knows each cut edge";
  }
}

TEST(SpringPatchCut, ReportsEveryCutInAMovingWindow) {
  SpringPatchParameters p = stretched();
  p.nodes = 1000;
  p.node_mass_kg = 0.02;
  PressedPatch pressed(p, 60);
  pressed.patch().respond({.surface_point = {3600, {0.3, 0.3, 0.4}}, .indentation_m = 0.001});
  pressed.advance();
  for (const double y : {-0.0054, -0.0021, 0.0012, 0.0045})
    pressed.patch().cut(stroke(-0.02, 0.02, y));
  const auto cut = pressed.patch().region().cut_triangles();
  ASSERT_GT(cut.size(), contact::kCutWindow);
  std::vector<std::uint32_t> reported(cut.size(), 0xFFFFFFFFu);
  contact::PatchShape shape;
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(pressed.patch().shape(shape));
    EXPECT_EQ(shape.cut_total, cut.size());
    for (std::uint32_t c = 0; c < shape.cut_count; ++c)
      reported[shape.cut_first + c] = shape.cut_triangle[c];
  }
  EXPECT_TRUE(std::equal(reported.begin(), reported.end(), cut.begin()));
}

TEST(SpringPatchCut, AFullListCutsNoMore) {
  SpringPatchParameters p = soft_patch();
  p.nodes = 1024;
  p.node_mass_kg = 0.05;
  PressedPatch pressed(p, 40);
  pressed.patch().respond({.surface_point = {1640, {0.3, 0.3, 0.4}}, .indentation_m = 0.001});
  pressed.advance();
  for (int i = 0; i < 80; ++i) pressed.patch().cut(stroke(-0.06, 0.06, -0.0498 + 0.00125 * i));
  EXPECT_LE(pressed.patch().region().cut_triangles().size(), kMaxCutTriangles);
  EXPECT_GT(pressed.patch().region().cut_triangles().size(), kMaxCutTriangles - 3);
  const std::size_t left = pressed.patch().region().spring_count();
  EXPECT_GT(left, 100u);
  pressed.advance(100);
  EXPECT_TRUE(std::isfinite(pressed.patch().stored_energy_J()));
}

TEST(SpringPatchCut, NeedsAContactAndABladeThatMoves) {
  PressedPatch pressed(soft_patch());
  pressed.patch().cut(stroke(-0.02, 0.02, 0.0024));  // nothing is stepped yet
  EXPECT_EQ(pressed.patch().region().cut_triangles().size(), 0u);
  settle(pressed, 1e-6, 1);
  pressed.patch().cut(stroke(0.002, 0.002, 0.0024));
  pressed.patch().cut(stroke(std::nan(""), 0.02, 0.0024));
  EXPECT_EQ(pressed.patch().region().cut_triangles().size(), 0u);
}

}  // namespace tact::model::springs::spring_patch_cut_test
