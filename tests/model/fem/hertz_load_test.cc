// SPDX-License-Identifier: Apache-2.0
#include "model/fem/hertz_load.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/fem/linear_solver.h"
#include "tests/model/fem/tet_blocks.h"

namespace tact::model::fem::hertz_load_test {

constexpr Elasticity kTissue{.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45};
constexpr double kPatch_m = 0.005;

// Finer towards 0, `cells` a side, out to reach.
std::vector<double> graded(double reach_m, int cells) {
  std::vector<double> out;
  for (int i = -cells; i <= cells; ++i) {
    const double x = static_cast<double>(i) / cells;
    out.push_back(reach_m * std::copysign(std::pow(std::abs(x), 1.4), x));
  }
  return out;
}

// A block of 100 x 100 x 50 mm under its top face z = 0, finest in the middle of the top.
TetMesh half_space() {
  const auto steps = graded(0.05, 4);
  return tests::tet_block(steps, steps, {steps.begin(), steps.begin() + 5});
}

std::uint32_t node_at(const TetMesh& mesh, const Vec3& p_m) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 0; i < mesh.node_m.size(); ++i)
    if (norm(mesh.node_m[i] - p_m) < norm(mesh.node_m[best] - p_m)) best = i;
  return best;
}

TEST(HertzLoad, SharesOutTheWholeForceAroundItsMiddle) {
  const TetMesh mesh = half_space();
  const Boundary boundary = find_boundary(mesh);
  double sum = 0.0;
  Vec3 middle_m{};
  for (const NodeWeight& w : hertz_weights(mesh, boundary, node_at(mesh, {}), kPatch_m)) {
    sum += w.weight;
    middle_m += w.weight * mesh.node_m[w.node];
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_LT(norm(middle_m), 0.1 * kPatch_m);
}

TEST(HertzLoad, StaysOnItsSideOfAThinLobe) {
  const TetMesh mesh =
      tests::tet_block(tests::even_steps(0.04, 20), tests::even_steps(0.04, 20), {0.0, 0.002});
  const Boundary boundary = find_boundary(mesh);
  for (const NodeWeight& w :
       hertz_weights(mesh, boundary, node_at(mesh, {0.02, 0.02, 0.002}), kPatch_m))
    EXPECT_GT(mesh.node_m[w.node].z, 0.001);
}

TEST(HertzLoad, AHalfSpaceIsContinuousAndFarAwayOnlyFeelsTheForce) {
  const double inside = hertz_displacement_m_per_N(kTissue, kPatch_m, kPatch_m * (1.0 - 1e-9));
  EXPECT_NEAR(hertz_displacement_m_per_N(kTissue, kPatch_m, kPatch_m * (1.0 + 1e-9)), inside,
              1e-6 * inside);
  // Boussinesq: u = F / (pi E* rho)
  const double far = 1.0 / (std::numbers::pi * kTissue.contact_modulus_Pa() * 0.5);
  EXPECT_NEAR(hertz_displacement_m_per_N(kTissue, kPatch_m, 0.5), far, 1e-4 * far);
}

/// Compliance of the block as the patch feels it, less that of a half-space, m/N.
struct Regular {
  double normal = 0.0, side = 0.0;
};

Regular regular_of(LinearSolver& solver, const TetMesh& mesh, double radius_m) {
  const auto patch = hertz_weights(mesh, find_boundary(mesh), node_at(mesh, {}), radius_m);
  std::vector<std::vector<NodeLoad>> loads(2);
  std::vector<std::uint32_t> wanted;
  for (const NodeWeight& w : patch) {
    loads[0].push_back({w.node, {0.0, 0.0, w.weight}});
    loads[1].push_back({w.node, {w.weight, 0.0, 0.0}});
    wanted.push_back(w.node);
  }
  std::vector<std::vector<Vec3>> u_m(2);
  solver.solve(loads, wanted, u_m);
  Regular out{-hertz_normal_m_per_N(kTissue, radius_m),
              -hertz_tangential_m_per_N(kTissue, radius_m)};
  for (std::size_t i = 0; i < patch.size(); ++i) {
    out.normal += patch[i].weight * u_m[0][i].z;
    out.side += patch[i].weight * u_m[1][i].x;
  }
  return out;
}

// 3 / (5 E* a0) is 0.034 m/N for 14 mm and 0.024 for 20 mm; what is left must be the block's own.
TEST(HertzLoad, WhatAHalfSpaceDoesNotExplainHardlyDependsOnThePatch) {
  const TetMesh mesh = half_space();
  std::vector<std::uint32_t> bottom;
  for (std::uint32_t i = 0; i < mesh.node_m.size(); ++i)
    if (mesh.node_m[i].z < -0.0499) bottom.push_back(i);
  auto solver = make_linear_solver(mesh, kTissue, bottom);
  ASSERT_TRUE(solver) << solver.error().message;
  const Regular small = regular_of(*solver, mesh, 0.014), large = regular_of(*solver, mesh, 0.020);
  EXPECT_NEAR(small.normal, large.normal, 0.04 * hertz_normal_m_per_N(kTissue, 0.014));
  EXPECT_NEAR(small.side, large.side, 0.04 * hertz_tangential_m_per_N(kTissue, 0.014));
  // A round block of this size, by CalculiX and another load: r = -6.7e-3 m/N (RF-3, a flat
  // punch); this one is square.
  EXPECT_NEAR(large.normal, -6.7e-3, 1.5e-3);
}

}  // namespace tact::model::fem::hertz_load_test
