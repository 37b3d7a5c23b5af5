// SPDX-License-Identifier: Apache-2.0
// The region that is stepped: what it holds, what leaving it does, and that the tool gains nothing.
#include "model/springs/patch_region.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/model/springs/patch_fixture.h"

namespace tact::model::springs::patch_region_test {

using tests::PressedPatch;
using tests::soft_patch;

TEST(PatchRegion, HoldsTheNearestVerticesAndAllTheirSprings) {
  const mesh::SurfaceMesh mesh = tests::make_plate(0.1, 20);
  PatchRegion region(make_patch_surface(mesh.view(), soft_patch().tissue), 0.002, 100);
  const std::array<std::uint32_t, 1> triangle{420};
  region.gather(triangle);
  ASSERT_EQ(region.vertices().size(), 100u);
  const std::set<std::uint32_t> inside(region.vertices().begin(), region.vertices().end());
  EXPECT_EQ(inside.size(), 100u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(region.vertices()[i], mesh.triangle[420][i]);
  const SpringNetwork network = region.network({});
  std::size_t free = 0;
  for (std::uint32_t slot = 0; slot < 100; ++slot) {
    EXPECT_EQ(region.slot_of(region.vertices()[slot]), slot);
    if (network.node.inverse_mass_per_kg[slot] == 0.0) continue;
    ++free;
    std::size_t springs = 0;
    for (const Spring& s : network.spring) springs += s.i == slot || s.j == slot ? 1 : 0;
    EXPECT_EQ(springs, region.surface().edges_at(region.vertices()[slot]).size());
  }
  EXPECT_GT(free, 50u);
  EXPECT_TRUE(region.holds(420));
  EXPECT_FALSE(region.holds(0));
}

TEST(PatchRegion, SurfaceBalancesItsPretensionAtRest) {
  const mesh::SurfaceMesh ball = tests::make_ball(0.03, 3);
  PatchTissue tissue = soft_patch().tissue;
  tissue.pretension_ratio = 0.2;
  PatchRegion region(make_patch_surface(ball.view(), tissue), 0.002, 200);
  const std::array<std::uint32_t, 1> triangle{0};
  region.gather(triangle);
  const SpringNetwork network = region.network({});
  std::vector<Vec3> f(200);
  const double energy_J = forces(network, network.node.position_m, network.node.velocity_mps, f);
  EXPECT_NEAR(energy_J, region.rest_energy_J(), 1e-15);
  double pull_N = 0.0;
  for (std::size_t i = 0; i < 200; ++i) {
    if (network.node.inverse_mass_per_kg[i] == 0.0) continue;
    EXPECT_LT(norm(f[i]), 1e-13);
    pull_N = std::max(pull_N, norm(network.node.load_N[i]));
  }
  EXPECT_GT(pull_N, 1e-3) << "a curved surface has a net pull to balance";
}

TEST(PatchRegion, BodyStiffnessIsSharedByArea) {
  const mesh::SurfaceMesh mesh = tests::make_plate(0.1, 20);
  const PatchSurface surface = make_patch_surface(mesh.view(), soft_patch().tissue);
  double sum_N_per_m = 0.0;
  for (const double a : surface.anchor_N_per_m) sum_N_per_m += a;
  EXPECT_NEAR(sum_N_per_m / 441.0, 5.0, 1e-12);
  // a corner of one triangle has a sixth of what six around a vertex give
  const auto [least, most] =
      std::minmax_element(surface.anchor_N_per_m.begin(), surface.anchor_N_per_m.end());
  EXPECT_NEAR(*most / *least, 6.0, 1e-9);
}

// Every vertex anywhere, moving at random, and then another region: energy is not made.
TEST(PatchRegion, GatheringMakesNoEnergyBeyondItsDebt) {
  const mesh::SurfaceMesh mesh = tests::make_plate(0.1, 20);
  for (const double speed_mps : {0.0, 0.01, 1.0}) {
    PatchRegion region(make_patch_surface(mesh.view(), soft_patch().tissue), 0.002, 100);
    const auto energy_J = [&region] {
      const SpringNetwork now = region.network({});
      return stored_energy_J(now) + kinetic_energy_J(now) - region.rest_energy_J();
    };
    std::array<std::uint32_t, 1> triangle{420};
    region.gather(triangle);
    for (std::uint32_t i = 0; i < 100; ++i) {
      const SpringNodes node = region.network({}).node;
      if (node.inverse_mass_per_kg[i] == 0.0) continue;
      node.position_m[i].x += 0.002 * std::exp(-0.03 * i);
      node.velocity_mps[i] = {0.0, speed_mps * std::sin(i), speed_mps};
    }
    for (const std::uint32_t next : {426u, 436u, 420u, 440u}) {
      triangle[0] = next;
      const double before_J = energy_J(), owed_J = region.energy_deficit_J();
      region.gather(triangle);
      EXPECT_LE(energy_J(), before_J + region.energy_deficit_J() - owed_J + 1e-15);
    }
  }
}

TEST(PatchRegion, AStayingVertexKeepsItsDisplacement) {
  SpringPatchParameters p = soft_patch();
  p.nodes = 60;
  PressedPatch pressed(p);
  for (int i = 0; i < 300; ++i) {
    pressed.move_to(0.0, 0.0, 0.004);
    pressed.advance();
  }
  const PatchRegion& region = pressed.patch().region();
  const std::uint32_t touched = region.vertices()[0];
  const Vec3 indentation_m = region.moved_m(touched);
  pressed.move_to(0.012, 0.0, 1e-6);
  pressed.advance();
  EXPECT_NE(region.vertices()[0], touched) << "gathered again";
  ASSERT_NE(region.slot_of(touched), kNoSlot);
  EXPECT_NEAR(norm(region.moved_m(touched) - indentation_m), 0.0, 0.1 * norm(indentation_m));
}

TEST(PatchRegion, ALeavingVertexReturnsToRest) {
  SpringPatchParameters p = soft_patch();
  p.nodes = 60;
  PressedPatch pressed(p);
  for (int i = 0; i < 300; ++i) {
    pressed.move_to(0.0, 0.0, 0.004);
    pressed.advance();
  }
  const std::uint32_t touched = pressed.patch().region().vertices()[0];
  EXPECT_GT(norm(pressed.patch().region().moved_m(touched)), 1e-4);
  pressed.move_to(0.04, 0.04, 0.004);
  pressed.advance();
  EXPECT_EQ(pressed.patch().region().slot_of(touched), kNoSlot);
  EXPECT_EQ(pressed.patch().region().moved_m(touched), Vec3{});
}

// Small regions that are gathered again and again, at once and in the middle of motion.
TEST(PatchRegion, HandingOverNeverGivesTheToolEnergy) {
  for (const std::size_t nodes : {40u, 80u, 120u}) {
    for (const double stretch : {0.0, 0.1}) {
      for (const double speed_m : {0.00005, 0.0005}) {  // a tick
        SpringPatchParameters p = soft_patch();
        p.nodes = nodes;
        p.tissue.pretension_ratio = stretch;
        PressedPatch pressed(p);
        double most_J = 0.0, least_J = 0.0;
        const int ticks = static_cast<int>(0.12 / speed_m);
        for (int stroke = 0; stroke < 2; ++stroke) {
          for (int i = 1; i <= ticks; ++i) {
            const double phase = 2.0 * std::numbers::pi * i / ticks;
            pressed.move_to(0.02 * std::sin(phase), 0.012 * std::sin(2.0 * phase),
                            0.003 * (1.0 - std::cos(phase)));
            most_J = std::max(most_J, pressed.work_J());
            least_J = std::min(least_J, pressed.work_J());
            pressed.advance();
          }
        }
        const double energy_deficit_J = pressed.patch().region().energy_deficit_J();
        EXPECT_GT(pressed.work_J(), -1e-9) << nodes << " nodes, " << stretch << ", " << speed_m;
        EXPECT_GT(least_J, -1e-9);
        // 40 nodes are three rings: the rim is in the indentation
        EXPECT_LT(energy_deficit_J, (nodes == 40 ? 0.1 : 0.01) * most_J)
            << nodes << " nodes, " << stretch << ", " << speed_m;
      }
    }
  }
}

}  // namespace tact::model::springs::patch_region_test
