// SPDX-License-Identifier: Apache-2.0
#include "model/fem/elasticity.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/model/fem/tet_blocks.h"

namespace tact::model::fem::elasticity_test {

constexpr Elasticity kTissue{.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45};

// Corners displaced inside the block, middles in the middle again: no two elements alike.
TetMesh distorted_block() {
  TetMesh mesh = tests::tet_block(tests::even_steps(0.03, 3), tests::even_steps(0.03, 3),
                                  tests::even_steps(0.03, 3));
  for (std::size_t i = 0; i < 64; ++i) {
    Vec3& p = mesh.node_m[i];
    const auto inside = [](double c) { return c > 0.001 && c < 0.029; };
    if (inside(p.x) && inside(p.y) && inside(p.z))
      p += 0.0015 * Vec3{std::sin(7.0 * static_cast<double>(i)),
                         std::cos(3.0 * static_cast<double>(i)),
                         std::sin(5.0 * static_cast<double>(i))};
  }
  constexpr std::array<std::array<std::size_t, 2>, 6> kEdge{
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  for (const TetNodes& e : mesh.element)
    for (std::size_t k = 0; k < 6; ++k)
      mesh.node_m[e[4 + k]] = 0.5 * (mesh.node_m[e[kEdge[k][0]]] + mesh.node_m[e[kEdge[k][1]]]);
  return mesh;
}

Eigen::VectorXd forces(const StiffnessMatrix& lower, const Eigen::VectorXd& u) {
  return lower.selfadjointView<Eigen::Lower>() * u;
}

template <typename Field>
Eigen::VectorXd field(const TetMesh& mesh, const Field& at) {
  Eigen::VectorXd u(static_cast<Eigen::Index>(3 * mesh.node_m.size()));
  for (std::size_t i = 0; i < mesh.node_m.size(); ++i) {
    const Vec3 v = at(mesh.node_m[i]);
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) << v.x, v.y, v.z;
  }
  return u;
}

TEST(Elasticity, MovingAndTurningTheWholeBodyTakesNoForce) {
  const TetMesh mesh = distorted_block();
  const auto k = assemble_stiffness(mesh, kTissue, free_nodes(mesh.node_m.size(), {}));
  ASSERT_TRUE(k) << k.error().message;
  const auto moved = field(mesh, [](const Vec3&) { return Vec3{1.0, -2.0, 3.0}; });
  const auto turned = field(mesh, [](const Vec3& p) { return cross({0.3, -0.2, 0.5}, p); });
  EXPECT_LT(forces(*k, moved).cwiseAbs().maxCoeff(), 1e-9 * 5000.0);
  EXPECT_LT(forces(*k, turned).cwiseAbs().maxCoeff(), 1e-9 * 5000.0);
}

TEST(Elasticity, UniformStrainPassesThePatchTest) {
  // u = A x: inner nodes stay in balance, and the energy is that of Hooke's law.
  const TetMesh mesh = distorted_block();
  const auto k = assemble_stiffness(mesh, kTissue, free_nodes(mesh.node_m.size(), {}));
  ASSERT_TRUE(k);
  const auto u = field(mesh, [](const Vec3& p) {
    return Vec3{0.01 * p.x + 0.004 * p.y, -0.02 * p.y + 0.006 * p.z, 0.015 * p.z};
  });
  const Eigen::VectorXd f = forces(*k, u);
  for (std::size_t i = 0; i < mesh.node_m.size(); ++i) {
    const Vec3& p = mesh.node_m[i];
    const auto inside = [](double c) { return c > 1e-9 && c < 0.03 - 1e-9; };
    if (!inside(p.x) || !inside(p.y) || !inside(p.z)) continue;
    EXPECT_LT(f.segment<3>(static_cast<Eigen::Index>(3 * i)).norm(), 1e-12);
  }
  // lambda = 5000 0.45 / (1.45 0.1) = 15517.24, mu = 5000 / 2.9 = 1724.138 Pa; trace 0.005;
  // e:e = 0.01^2 + 0.02^2 + 0.015^2 + 2 (0.002^2 + 0.003^2) = 7.51e-4; volume 2.7e-5 m^3
  // U = (lambda/2 0.005^2 + mu 7.51e-4) 2.7e-5 = 4.019742e-5 J
  EXPECT_NEAR(0.5 * u.dot(f), (15517.2414 / 2 * 2.5e-5 + 1724.13793 * 7.51e-4) * 2.7e-5, 1e-13);
}

TEST(Elasticity, FixedNodesHaveNoUnknowns) {
  const FreeNodes free = free_nodes(4, {2, 0, 2});
  EXPECT_EQ(free.unknowns, 6);
  EXPECT_EQ(free.first_unknown, (std::vector<std::int32_t>{-1, 0, -1, 3}));
}

TEST(Elasticity, RefusesWhatHasNoMeaning) {
  TetMesh mesh = tests::tet_block({0.0, 1.0}, {0.0, 1.0}, {0.0, 1.0});
  const FreeNodes free = free_nodes(mesh.node_m.size(), {});
  EXPECT_FALSE(assemble_stiffness(mesh, {0.0, 0.3}, free));
  EXPECT_FALSE(assemble_stiffness(mesh, {1.0, 0.5}, free));
  EXPECT_FALSE(assemble_stiffness(mesh, {1.0, std::nan("")}, free));
  TetNodes& e = mesh.element[3];
  std::swap(e[8], e[9]);
  EXPECT_FALSE(assemble_stiffness(mesh, {1.0, 0.3}, free)) << "another program's order of nodes";
  std::swap(e[8], e[9]);
  EXPECT_TRUE(assemble_stiffness(mesh, {1.0, 0.3}, free));
  std::swap(e[0], e[1]), std::swap(e[5], e[6]), std::swap(e[7], e[8]);
  const auto inside_out = assemble_stiffness(mesh, {1.0, 0.3}, free);
  ASSERT_FALSE(inside_out);
  EXPECT_NE(inside_out.error().message.find("element 3"), std::string::npos);
}

}  // namespace tact::model::fem::elasticity_test
