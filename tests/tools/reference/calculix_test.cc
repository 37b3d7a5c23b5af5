// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/calculix/calculix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "tests/support/needs_calculix.h"
#include "tools/ground_truth/gmsh.h"
#include "tools/program/run_program.h"

namespace tact::tools::reference::calculix_test {

using model::Vec3;
using model::fem::TetMesh;

constexpr double kSide_m = 0.01;
constexpr Elasticity kTissue{.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45};

/// A cube from the origin, counter-clockwise triangles seen from outside.
const TetMesh& cube() {
  static const TetMesh body = [] {
    std::vector<Vec3> vertex;
    for (int i = 0; i < 8; ++i)
      vertex.push_back(kSide_m * Vec3{i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
    const std::vector<model::contact::TriangleCorners> triangle{
        {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
        {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    const auto filled = ground_truth::fill_with_gmsh(
        vertex, triangle,
        {.at_m = {}, .axis = {}, .radius_m = 1.0, .fine_m = 0.5 * kSide_m, .growth = 0.0});
    EXPECT_TRUE(filled) << filled.error().message;
    return filled ? *filled : TetMesh{};
  }();
  return body;
}

/// The cube with every node told where to go by `along_m` on its surface; nothing is held.
ElasticProblem moved_along(const Vec3& direction, double (*along_m)(const Vec3&), bool bonded) {
  ElasticProblem p{.body = &cube(),
                   .material = kTissue,
                   .held = {},
                   .load = {.direction = direction, .moved = {}, .sideways_held = bonded},
                   .reported = {}};
  for (std::uint32_t n = 0; n < p.body->node_m.size(); ++n) {
    const Vec3& x = p.body->node_m[n];
    const bool outside =
        std::min({x.x, x.y, x.z}) < 1e-9 || std::max({x.x, x.y, x.z}) > kSide_m - 1e-9;
    if (outside) p.load.moved.push_back({n, along_m(x)});
    p.reported.push_back(n);
  }
  return p;
}

TEST(Gmsh, FillsACubeToItsVolumeAndKeepsItsVertices) {
  const TetMesh& body = cube();
  ASSERT_GT(body.element.size(), 5U);
  EXPECT_NEAR(volume_m3(body), 1e-6, 1e-18);
  EXPECT_EQ(body.node_m[7], (Vec3{kSide_m, kSide_m, kSide_m}));
  for (const auto& e : body.element) {  // middles are where C3D10 wants them
    EXPECT_EQ(body.node_m[e[4]], 0.5 * (body.node_m[e[0]] + body.node_m[e[1]]));
    EXPECT_EQ(body.node_m[e[6]], 0.5 * (body.node_m[e[2]] + body.node_m[e[0]]));
    EXPECT_EQ(body.node_m[e[9]], 0.5 * (body.node_m[e[2]] + body.node_m[e[3]]));
  }
}

TEST(Gmsh, RefusesAnOpenSurfaceAndKeepsItsLog) {
  auto where =
      program::ScratchFolder::make("tact-calculix-test");  // for the log, so that it goes too
  ASSERT_TRUE(where) << where.error().message;
  setenv("TMPDIR", where->path().c_str(), 1);
  const std::vector<Vec3> vertex{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}};
  const std::vector<model::contact::TriangleCorners> triangle{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}};
  const auto body = ground_truth::fill_with_gmsh(
      vertex, triangle, {.at_m = {}, .axis = {}, .radius_m = 1.0, .fine_m = 0.01, .growth = 0.0});
  unsetenv("TMPDIR");
  ASSERT_FALSE(body);
  EXPECT_NE(body.error().message.find(where->path()), std::string::npos) << body.error().message;
  EXPECT_FALSE(std::filesystem::is_empty(where->path()));
}

using SolvedByCalculiX = tests::NeedsCalculiX;

TEST_F(SolvedByCalculiX, PassesThePatchTest) {
  // A linear displacement is in the element's space: inside it must be linear too, exactly.
  const Vec3 direction = normalized(Vec3{0.3, -0.5, 0.8});
  const auto linear = [](const Vec3& x) { return 1e-3 * (2.0 * x.x - x.y + 0.5 * x.z); };
  const auto answer = solve_with_calculix(moved_along(direction, linear, true));
  ASSERT_TRUE(answer) << answer.error().message;
  for (std::uint32_t n = 0; n < cube().node_m.size(); ++n) {
    const Vec3 off_m = answer->displacement_m[n] - linear(cube().node_m[n]) * direction;
    EXPECT_LT(norm(off_m), 1e-6 * 1e-3 * kSide_m) << "node " << n;
  }
  EXPECT_LT(norm(answer->force_N), 1e-9) << "constant stress has no resultant";
}

TEST_F(SolvedByCalculiX, GivesYoungsModulusInTension) {
  // nu = 0: the held bottom does not hinder, and F = E A strain = 5000 * 1e-4 * 1e-3 = 0.5 mN.
  ElasticProblem p{.body = &cube(),
                   .material = {.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.0},
                   .held = {},
                   .load = {.direction = {0, 0, 1}, .moved = {}},
                   .reported = {7}};
  for (std::uint32_t n = 0; n < p.body->node_m.size(); ++n) {
    const double z_m = p.body->node_m[n].z;
    if (z_m < 1e-9) p.held.push_back(n);
    if (z_m > kSide_m - 1e-9) p.load.moved.push_back({n, 1e-3 * kSide_m});
  }
  const auto answer = solve_with_calculix(p);
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_NEAR(answer->force_N.z, 0.5e-3, 1e-6 * 0.5e-3);
  EXPECT_NEAR(std::hypot(answer->force_N.x, answer->force_N.y), 0.0, 1e-9);
  EXPECT_LT(norm(answer->displacement_m[0] - Vec3{0, 0, 1e-5}), 1e-11);
}

/// Work of squeezing the cube along z with its sides confined.
double confined_work_J(bool large_strain) {
  ElasticProblem p = moved_along({0, 0, 1}, [](const Vec3& x) { return -1e-3 * x.z; }, true);
  p.load.large_strain = large_strain;
  const auto answer = solve_with_calculix(p);
  EXPECT_TRUE(answer) << answer.error().message;
  double sum_J = 0.0;
  for (std::size_t i = 0; answer && i < p.load.moved.size(); ++i)
    sum_J += 0.5 * answer->moved_force_N[i].z * p.load.moved[i].along_m;
  return sum_J;
}

TEST_F(SolvedByCalculiX, KnowsBothElasticConstantsAlsoAtLargeStrain) {
  // W = E (1 - nu) / ((1 + nu)(1 - 2 nu)) strain^2 / 2 V; at 0.1 % neo-Hookean is the same.
  const double modulus_Pa = 5000.0 * 0.55 / (1.45 * 0.1);
  const double work_J = 0.5 * modulus_Pa * 1e-6 * 1e-6;
  EXPECT_NEAR(confined_work_J(false), work_J, 1e-5 * work_J);
  EXPECT_NEAR(confined_work_J(true), work_J, 5e-3 * work_J);
}

TEST(CalculiX, SaysWhatToInstall) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const auto version = calculix_version();
  const auto gmsh = ground_truth::gmsh_version();
  setenv("PATH", path.c_str(), 1);
  ASSERT_FALSE(version);
  EXPECT_EQ(version.error().message, "ccx is not installed; apt install calculix-ccx");
  ASSERT_FALSE(gmsh);
  EXPECT_EQ(gmsh.error().message, "gmsh is not installed; apt install gmsh");
}

TEST_F(SolvedByCalculiX, TellsItsVersion) {
  const auto version = calculix_version();
  ASSERT_TRUE(version) << version.error().message;
  EXPECT_EQ(version->substr(0, 2), "2.") << *version;
}

}  // namespace tact::tools::reference::calculix_test
