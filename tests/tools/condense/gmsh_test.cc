// SPDX-License-Identifier: Apache-2.0
#include "tools/condense/gmsh.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tools/program/run_program.h"

namespace tact::tools::condense::gmsh_test {

using model::Vec3;
using model::contact::TriangleCorners;

constexpr double kSide_m = 0.01;

TEST(Gmsh, FillsACubeToItsVolumeAndKeepsItsVertices) {
  std::vector<Vec3> vertex;
  for (int i = 0; i < 8; ++i)
    vertex.push_back(kSide_m * Vec3{i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
  // counter-clockwise seen from outside
  const std::vector<TriangleCorners> triangle{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                              {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                              {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const auto body = fill_with_gmsh(vertex, triangle, 0.5 * kSide_m);
  ASSERT_TRUE(body) << body.error().message;
  ASSERT_GT(body->element.size(), 5U);
  EXPECT_EQ(body->node_m[7], (Vec3{kSide_m, kSide_m, kSide_m}));
  const auto& node_m = body->node_m;
  double volume_m3 = 0.0;
  for (const auto& e : body->element) {
    const Vec3& o = node_m[e[0]];
    volume_m3 += dot(node_m[e[1]] - o, cross(node_m[e[2]] - o, node_m[e[3]] - o)) / 6.0;
    EXPECT_EQ(node_m[e[4]], 0.5 * (node_m[e[0]] + node_m[e[1]])) << "the order of tet_mesh.h";
    EXPECT_EQ(node_m[e[6]], 0.5 * (node_m[e[2]] + node_m[e[0]]));
    EXPECT_EQ(node_m[e[9]], 0.5 * (node_m[e[2]] + node_m[e[3]]));
  }
  EXPECT_NEAR(volume_m3, 1e-6, 1e-18);
}

TEST(Gmsh, RefusesAnOpenSurfaceAndKeepsItsLog) {
  auto where = program::ScratchFolder::make("tact-gmsh-test");  // for the log, so that it goes too
  ASSERT_TRUE(where) << where.error().message;
  setenv("TMPDIR", where->path().c_str(), 1);
  const std::vector<Vec3> vertex{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}};
  const std::vector<TriangleCorners> triangle{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}};
  const auto body = fill_with_gmsh(vertex, triangle, 0.01);
  unsetenv("TMPDIR");
  ASSERT_FALSE(body);
  EXPECT_NE(body.error().message.find(where->path()), std::string::npos) << body.error().message;
  EXPECT_FALSE(std::filesystem::is_empty(where->path()));
}

TEST(Gmsh, SaysWhatToInstall) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const auto version = gmsh_version();
  setenv("PATH", path.c_str(), 1);
  ASSERT_FALSE(version);
  EXPECT_EQ(version.error().message, "gmsh is not installed; apt install gmsh");
}

}  // namespace tact::tools::condense::gmsh_test
