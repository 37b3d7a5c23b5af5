// SPDX-License-Identifier: Apache-2.0
#include "model/fem/linear_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/model/fem/tet_blocks.h"

namespace tact::model::fem::linear_solver_test {

template <typename Which>
std::vector<std::uint32_t> nodes_where(const TetMesh& mesh, const Which& which) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < mesh.node_m.size(); ++i)
    if (which(mesh.node_m[i])) out.push_back(i);
  return out;
}

// 100 x 10 x 10 mm, fixed at x = 0.
TetMesh beam() {
  return tests::tet_block(tests::even_steps(0.1, 20), tests::even_steps(0.01, 2),
                          tests::even_steps(0.01, 2));
}

LinearSolver solver_of(const TetMesh& mesh, const Elasticity& material) {
  auto solver = make_linear_solver(mesh, material,
                                   nodes_where(mesh, [](const Vec3& p) { return p.x < 1e-9; }));
  EXPECT_TRUE(solver) << solver.error().message;
  return std::move(*solver);
}

/// Of every node.
std::vector<Vec3> solved(LinearSolver& solver, const TetMesh& mesh, std::vector<NodeLoad> load) {
  const std::vector<std::vector<NodeLoad>> loads{std::move(load)};
  std::vector<std::uint32_t> every(mesh.node_m.size());
  std::iota(every.begin(), every.end(), 0U);
  std::vector<std::vector<Vec3>> u_m(1);
  solver.solve(loads, every, u_m);
  return u_m[0];
}

TEST(LinearSolver, BendsABeamAsTheBookSays) {
  // Tip load P, L = 10 h: w = P L^3 / (3 E I) + 1.2 P L / (G A) [Timoshenko].
  const TetMesh mesh = beam();
  LinearSolver solver = solver_of(mesh, {.youngs_modulus_Pa = 1e6, .poisson_ratio = 0.3});
  const auto tip = nodes_where(mesh, [](const Vec3& p) { return p.x > 0.1 - 1e-9; });
  std::vector<NodeLoad> load;
  for (const std::uint32_t node : tip)
    load.push_back({node, Vec3{0.0, 0.0, 0.01 / static_cast<double>(tip.size())}});
  const std::vector<Vec3> u_m = solved(solver, mesh, load);
  double mean_m = 0.0;
  for (const std::uint32_t node : tip) mean_m += u_m[node].z / static_cast<double>(tip.size());
  const double i_m4 = 1e-8 / 12.0, shear_Pa = 1e6 / 2.6;
  const double book_m = 0.01 * 1e-3 / (3.0 * 1e6 * i_m4) + 1.2 * 0.01 * 0.1 / (shear_Pa * 1e-4);
  EXPECT_NEAR(mean_m / book_m, 1.0, 0.015);
}

TEST(LinearSolver, ManyLoadsGiveWhatEachGivesAlone) {
  const TetMesh mesh = beam();
  LinearSolver solver = solver_of(mesh, {.youngs_modulus_Pa = 1e4, .poisson_ratio = 0.45});
  std::vector<std::vector<NodeLoad>> loads(15);
  for (std::size_t c = 0; c < loads.size(); ++c)
    loads[c] = {
        {static_cast<std::uint32_t>(10 + 7 * c), {1e-3, 2e-3 * static_cast<double>(c), -1e-3}}};
  const std::vector<std::uint32_t> wanted{5, 0, 100};
  std::vector<std::vector<Vec3>> together(loads.size());
  solver.solve(loads, wanted, together);
  for (std::size_t c = 0; c < loads.size(); ++c) {
    const std::vector<Vec3> alone = solved(solver, mesh, loads[c]);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      EXPECT_LT(norm(together[c][i] - alone[wanted[i]]), 1e-12 * (1.0 + norm(alone[wanted[i]])));
  }
  EXPECT_EQ(together[0][1], Vec3{}) << "node 0 is fixed";
}

TEST(LinearSolver, WorkIsReciprocal) {
  // Maxwell and Betti: what a force at A moves at B, the same force at B moves at A.
  const TetMesh mesh = beam();
  LinearSolver solver = solver_of(mesh, {.youngs_modulus_Pa = 1e4, .poisson_ratio = 0.45});
  const auto from_a = solved(solver, mesh, {{50, {0.0, 0.0, 1.0}}}),
             from_b = solved(solver, mesh, {{120, {0.0, 1.0, 0.0}}});
  EXPECT_NEAR(from_a[120].y / from_b[50].z, 1.0, 1e-9);
}

TEST(LinearSolver, RefusesABodyThatIsNotHeld) {
  const TetMesh mesh = beam();
  const Elasticity material{1e4, 0.3};
  const auto loose = make_linear_solver(mesh, material, {});
  ASSERT_FALSE(loose);
  EXPECT_NE(loose.error().message.find("elastic.fixed_min_m to elastic.fixed_max_m"),
            std::string::npos)
      << "the keys that hold it";
  const auto edge = nodes_where(mesh, [](const Vec3& p) { return p.x < 1e-9 && p.y < 1e-9; });
  EXPECT_FALSE(make_linear_solver(mesh, material, edge)) << "it can turn about the edge";
  EXPECT_FALSE(
      make_linear_solver(mesh, material, nodes_where(mesh, [](const Vec3&) { return true; })));
}

}  // namespace tact::model::fem::linear_solver_test
