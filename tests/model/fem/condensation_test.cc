// SPDX-License-Identifier: Apache-2.0
#include "model/fem/condensation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/fem/hertz_load.h"
#include "model/fem/linear_solver.h"
#include "model/scene/compliance_file.h"
#include "tests/model/fem/tet_blocks.h"

namespace tact::model::fem::condensation_test {

struct Organ {
  mesh::SurfaceMesh surface;
  TetMesh body;  // first nodes: the surface's vertices
};

// 60 x 60 x 30 mm in cells of 15 mm, held at the bottom z = 0.
Organ block() {
  TetMesh mesh = tests::tet_block(tests::even_steps(0.06, 4), tests::even_steps(0.06, 4),
                                  tests::even_steps(0.03, 2));
  const Boundary skin = find_boundary(mesh);
  constexpr auto kNone = std::uint32_t{0xFFFFFFFF};
  std::vector<std::uint32_t> place(mesh.node_m.size(), kNone);
  std::uint32_t next = 0;
  for (const FaceNodes& f : skin.face)
    for (std::size_t i = 0; i < 3; ++i)
      if (place[f[i]] == kNone) place[f[i]] = next++;
  std::vector<Vec3> vertex_m(next);
  std::vector<contact::TriangleCorners> triangle;
  for (const FaceNodes& f : skin.face) triangle.push_back({place[f[0]], place[f[1]], place[f[2]]});
  for (std::uint32_t& at : place)
    if (at == kNone) at = next++;
  std::vector<Vec3> node_m(mesh.node_m.size());
  for (std::size_t i = 0; i < node_m.size(); ++i) node_m[place[i]] = mesh.node_m[i];
  mesh.node_m = std::move(node_m);
  for (TetNodes& e : mesh.element)
    for (std::uint32_t& node : e) node = place[node];
  for (std::size_t v = 0; v < vertex_m.size(); ++v) vertex_m[v] = mesh.node_m[v];
  auto surface = mesh::make_surface_mesh(std::move(vertex_m), std::move(triangle));
  EXPECT_TRUE(surface) << surface.error().message;
  return {std::move(*surface), std::move(mesh)};
}

CondensationSettings settings() {
  return {.poisson_ratio = 0.45,
          .fixed_min_m = {-1.0, -1.0, -1.0},
          .fixed_max_m = {1.0, 1.0, 1e-6},
          .patch_radius_m = 0.02,
          .ring_pitch_m = 0.008,
          .rings = 4,
          .run_jobs = one_after_the_other};
}

std::size_t vertex_at(const Organ& organ, const Vec3& p_m) {
  for (std::size_t v = 0; v < organ.surface.vertex_m.size(); ++v)
    if (norm(organ.surface.vertex_m[v] - p_m) < 1e-9) return v;
  ADD_FAILURE() << "no such vertex";
  return 0;
}

TEST(Condensation, KnowsWhereTheOrganIsStiffAndWhereItGives) {
  const Organ organ = block();
  const auto map = condense(organ.body, organ.surface.view(), settings());
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->vertices(), organ.surface.vertex_m.size());
  EXPECT_EQ(map->mesh_hash, scene::surface_hash(organ.surface.view()));
  const auto r_E = [&](const Vec3& p_m) {
    return map->regular_times_E_per_m[vertex_at(organ, p_m)];
  };
  const double half = hertz_normal_m_per_N({1.0, 0.45}, 0.02);
  const float middle = r_E({0.03, 0.03, 0.03}), edge = r_E({0.06, 0.03, 0.03});
  EXPECT_LT(middle, 0.0F) << "the held bottom is near";
  EXPECT_GT(edge, middle) << "beside it there is nothing to push";
  EXPECT_GT(r_E({0.06, 0.06, 0.03}), edge);
  EXPECT_NEAR(static_cast<double>(r_E({0.03, 0.03, 0.0})), -half, 1e-4 * half)
      << "a held place gives nothing: it is stiffer than a half-space by all of it";
}

TEST(Condensation, IsTheSolutionOfItsOwnLoads) {
  const Organ organ = block();
  const auto map = condense(organ.body, organ.surface.view(), settings());
  ASSERT_TRUE(map);
  const auto v = static_cast<std::uint32_t>(vertex_at(organ, {0.045, 0.015, 0.03}));
  const Boundary skin = find_boundary(organ.body);
  auto solver = make_linear_solver(
      organ.body, {1.0, 0.45},
      nodes_of_faces_in_box(organ.body, skin, settings().fixed_min_m, settings().fixed_max_m));
  ASSERT_TRUE(solver);
  const auto patch = hertz_weights(organ.body, skin, v, 0.02);
  const std::array<Vec3, 3> axis{organ.surface.vertex_normal[v], {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  std::array<std::array<double, 3>, 3> c{};
  std::vector<std::uint32_t> nodes;
  for (const NodeWeight& w : patch) nodes.push_back(w.node);
  std::vector<std::vector<NodeLoad>> loads(3);
  std::vector<std::vector<Vec3>> u_m(3);
  for (std::size_t q = 0; q < 3; ++q)
    for (const NodeWeight& w : patch) loads[q].push_back({w.node, w.weight * axis[q]});
  solver->solve(loads, nodes, u_m);
  for (std::size_t q = 0; q < 3; ++q)
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t i = 0; i < patch.size(); ++i)
        c[p][q] += patch[i].weight * dot(axis[p], u_m[q][i]);
  const double scale = c[0][0];
  const double r = c[0][0] - hertz_normal_m_per_N({1.0, 0.45}, 0.02);
  EXPECT_NEAR(static_cast<double>(map->regular_times_E_per_m[v]), r, 1e-6 * scale);
  const double side = hertz_tangential_m_per_N({1.0, 0.45}, 0.02);
  // Turned back from the axes that the map gives: here x and y are tangential.
  const tissue::SidewaysCompliance& s = map->sideways_times_E_per_m[v];
  const double ax = static_cast<double>(s.axis[0]), ay = static_cast<double>(s.axis[1]);
  const double found_xx = static_cast<double>(s.s1) * ax * ax + static_cast<double>(s.s2) * ay * ay;
  const double found_xy = static_cast<double>(s.s1 - s.s2) * ax * ay;
  EXPECT_NEAR(ax * ax + ay * ay, 1.0, 1e-6);
  EXPECT_NEAR(found_xx, c[1][1] - side, 1e-5 * scale);
  EXPECT_NEAR(found_xy, c[1][2], 1e-5 * scale);
  EXPECT_NEAR(static_cast<double>(s.n1) * ax - static_cast<double>(s.n2) * ay, c[0][1],
              1e-5 * scale);
  // Turning the tangential axes keeps the trace, the determinant and the length of (n1, n2).
  const double s1 = static_cast<double>(s.s1), s2 = static_cast<double>(s.s2);
  const double n1 = static_cast<double>(s.n1), n2 = static_cast<double>(s.n2);
  EXPECT_NEAR(s1 + s2, c[1][1] + c[2][2] - 2.0 * side, 1e-5 * scale);
  EXPECT_NEAR(s1 * s2, (c[1][1] - side) * (c[2][2] - side) - c[1][2] * c[1][2],
              1e-5 * scale * scale);
  EXPECT_NEAR(std::hypot(n1, n2), std::hypot(c[0][1], c[0][2]), 1e-5 * scale);
  EXPECT_NEAR(n1 * n1 * s1 + n2 * n2 * s2,
              c[0][1] * c[0][1] * (c[1][1] - side) + c[0][2] * c[0][2] * (c[2][2] - side) +
                  2.0 * c[0][1] * c[0][2] * c[1][2],
              1e-5 * scale * scale * scale);
}

TEST(Condensation, TheOrderOfItsJobsChangesNothing) {
  const Organ organ = block();
  CondensationSettings s = settings();
  const auto forward = condense(organ.body, organ.surface.view(), s);
  s.run_jobs = [](std::size_t jobs, std::span<float> results, const Work& work) {
    const std::size_t each = results.size() / jobs;
    while (jobs-- > 0) work(jobs, results.subspan(jobs * each, each));
    return std::optional<Error>();
  };
  const auto backward = condense(organ.body, organ.surface.view(), s);
  ASSERT_TRUE(forward && backward);
  EXPECT_EQ(forward->regular_times_E_per_m, backward->regular_times_E_per_m);
  EXPECT_EQ(forward->ring_times_E_per_m, backward->ring_times_E_per_m);
}

TEST(Condensation, StopsWithItsJobs) {
  const Organ organ = block();
  CondensationSettings s = settings();
  s.run_jobs = [](std::size_t, std::span<float>, const Work&) {
    return std::optional(Error{"stopped", ErrorCode::kInterrupted});
  };
  const auto map = condense(organ.body, organ.surface.view(), s);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().code, ErrorCode::kInterrupted);
}

TEST(Condensation, RefusesWhatItCannotSolve) {
  const Organ organ = block();
  const auto refused = [&](auto change) {
    CondensationSettings s = settings();
    change(s);
    return !condense(organ.body, organ.surface.view(), s);
  };
  EXPECT_TRUE(refused([](auto& s) { s.fixed_max_m = s.fixed_min_m; }));
  EXPECT_TRUE(refused([](auto& s) { s.patch_radius_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& s) { s.patch_radius_m = 1e-5; })) << "between the points of a sum";
  EXPECT_TRUE(refused([](auto& s) { s.rings = 32; }));
  EXPECT_TRUE(refused([](auto& s) { s.poisson_ratio = 0.5; }));
  Organ shifted = block();
  shifted.surface.vertex_m[3].x += 1e-4;
  EXPECT_FALSE(condense(shifted.body, shifted.surface.view(), settings()));
}

}  // namespace tact::model::fem::condensation_test
