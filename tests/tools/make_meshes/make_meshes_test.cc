// SPDX-License-Identifier: Apache-2.0
// The shipped meshes: what they must be, and that the generator gives the same bytes again.
// Expected sizes are those of the scenes, in m; a mesh file is in mm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/mesh/obj.h"
#include "tests/support/mesh_files.h"
#include "tests/tools/make_meshes/mesh_checks.h"

namespace tact::tests::make_meshes_test {

using model::mesh::MeshSummary;

std::string shipped(const std::string& name) {
  return std::string(TACT_SOURCE_DIR) + "/model/scenes/meshes/" + name;
}

SurfaceMesh load(const std::string& path) {
  auto obj = model::mesh::load_obj(path, 0.001);
  EXPECT_TRUE(obj.has_value()) << (obj ? "" : obj.error().sentence);
  if (!obj) return {};
  EXPECT_FALSE(obj->flipped);
  EXPECT_EQ(obj->welded_vertices + obj->unused_vertices, 0u);
  return std::move(obj->mesh);
}

// V - E + F: 2 for each ball, 0 for a ring, 1 less for each rim. E = (3 F + rim edges) / 2.
int euler(const MeshSummary& sum) {
  const auto edges = static_cast<int>(3 * sum.triangles + sum.boundary_edges) / 2;
  return static_cast<int>(sum.vertices) - edges + static_cast<int>(sum.triangles);
}

TEST(MakeMeshes, GivesTheShippedFilesByteForByte) {
  const TempDirectory temp;
  const Ran ran = run_apart(temp, "tact-make-meshes", "--out " + temp.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  for (const std::string name :
       {"liver_3116.obj", "forceps_174.obj", "heart_10026.obj", "hand_2865.obj", "skin.obj",
        "injector.obj", "gum.obj", "blade.obj", "cover.obj", "press.obj"}) {
    const std::string made = read_text(temp.path() + "/" + name);
    EXPECT_GT(made.size(), 5000u);
    EXPECT_TRUE(made == read_text(shipped(name))) << name << " differs";
  }
}

TEST(MakeMeshes, LiverIsAClosedBodyOfItsSize) {
  const SurfaceMesh liver = load(shipped("liver_3116.obj"));
  const MeshSummary sum = summarize(liver);
  EXPECT_EQ(sum.vertices, 3116u);
  EXPECT_EQ(sum.triangles, 6228u);
  EXPECT_EQ(sum.boundary_edges, 0u);
  EXPECT_EQ(euler(sum), 2);
  EXPECT_EQ(self_crossings(liver), 0);
  const Vec3 size_m = sum.high_m - sum.low_m;
  EXPECT_NEAR(size_m.x, 0.100, 0.001);
  EXPECT_NEAR(size_m.y, 0.150, 0.001);
  EXPECT_NEAR(size_m.z, 0.060, 0.001);
  EXPECT_GT(sum.volume_m3, 340e-6);
  EXPECT_LT(sum.volume_m3, 380e-6);
  EXPECT_GT(least_angle_deg(liver), 30.0);
}

TEST(MakeMeshes, LiverHasAGentleTopInTheMiddle) {
  const SurfaceMesh liver = load(shipped("liver_3116.obj"));
  int inside = 0;
  for (std::size_t v = 0; v < liver.vertex_m.size(); ++v) {
    const Vec3& p_m = liver.vertex_m[v];
    const double r_m = std::hypot(p_m.x, p_m.y);
    if (r_m > 0.015 || p_m.z < 0.0) continue;
    ++inside;
    EXPECT_LT(p_m.z, 0.0301);
    EXPECT_GT(p_m.z, 0.0270);
    // Convex: the normal leans outwards, by less than 25 degrees.
    EXPECT_GT(liver.vertex_normal[v].z, 0.90);
    if (r_m > 0.004) EXPECT_GT(dot(liver.vertex_normal[v], Vec3{p_m.x, p_m.y, 0}), 0.0);
  }
  EXPECT_GT(inside, 40);
}

TEST(MakeMeshes, LiverHasNoSharpCrease) {
  const SurfaceMesh liver = load(shipped("liver_3116.obj"));
  double sharpest = 1.0;
  for (std::size_t t = 0; t < liver.triangle.size(); ++t)
    for (const std::uint32_t across : liver.neighbour[t])
      sharpest = std::min(sharpest, dot(liver.face_normal[t], liver.face_normal[across]));
  EXPECT_GT(sharpest, std::cos(50.0 * M_PI / 180.0));
}

TEST(MakeMeshes, ForcepsAreClosedWithOneHole) {
  const SurfaceMesh forceps = load(shipped("forceps_174.obj"));
  const MeshSummary sum = summarize(forceps);
  EXPECT_EQ(sum.vertices, 174u);
  EXPECT_EQ(sum.triangles, 348u);
  EXPECT_EQ(sum.boundary_edges, 0u);
  EXPECT_EQ(euler(sum), 0);
  EXPECT_EQ(self_crossings(forceps), 0);
  EXPECT_GT(sum.volume_m3, 0.0);
  EXPECT_GT(least_angle_deg(forceps), 10.0);
}

TEST(MakeMeshes, ForcepsHaveTwoTipsAtTheOriginAndTheHandleAbove) {
  const SurfaceMesh forceps = load(shipped("forceps_174.obj"));
  const MeshSummary sum = summarize(forceps);
  EXPECT_NEAR(sum.low_m.z, 0.0, 0.0002);
  EXPECT_GT(sum.high_m.z, 0.075);
  EXPECT_LT(sum.high_m.z, 0.100);
  int right = 0, left = 0;
  for (const Vec3& p_m : forceps.vertex_m) {
    if (p_m.z > 0.001) continue;
    EXPECT_NEAR(std::abs(p_m.y), 0.004, 0.001);
    EXPECT_LT(std::abs(p_m.x), 0.0015);
    ++(p_m.y > 0.0 ? right : left);
  }
  EXPECT_EQ(right, 6);
  EXPECT_EQ(left, 6);
}

struct Expected {
  const char* file;
  std::size_t vertices, triangles, rim_edges;
  int euler;
  Vec3 size_m;
  double least_angle_deg;
};

TEST(MakeMeshes, EveryNewMeshIsSoundAndOfItsCountsAndSize) {
  const std::vector<Expected> all{
      {"heart_10026.obj", 10026, 19409, 645, 2 - 3, {0.126, 0.092, 0.077}, 18.0},
      {"hand_2865.obj", 2865, 5722, 0, 2 + 2, {0.059, 0.102, 0.180}, 25.0},
      {"skin.obj", 3000, 5996, 0, 2, {0.080, 0.120, 0.030}, 30.0},
      {"injector.obj", 482, 960, 0, 2, {0.024, 0.024, 0.112}, 15.0},
      {"gum.obj", 2300, 4596, 0, 2, {0.0495, 0.0596, 0.015}, 28.0},
      {"blade.obj", 107, 210, 0, 2, {0.0084, 0.0032, 0.140}, 2.0},  // a thin wedge
      {"cover.obj", 10000, 19996, 0, 2 + 0, {0.104, 0.124, 0.0141}, 20.0},
      {"press.obj", 738, 1472, 0, 2, {0.0232, 0.0232, 0.150}, 12.0}};
  for (const Expected& e : all) {
    const SurfaceMesh mesh = load(shipped(e.file));
    const MeshSummary sum = summarize(mesh);
    EXPECT_EQ(sum.vertices, e.vertices) << e.file;
    EXPECT_EQ(sum.triangles, e.triangles) << e.file;
    EXPECT_EQ(sum.boundary_edges, e.rim_edges) << e.file;
    EXPECT_EQ(euler(sum), e.euler) << e.file;
    EXPECT_EQ(self_crossings(mesh), 0) << e.file;
    EXPECT_GT(sum.volume_m3, 0.0) << e.file;
    EXPECT_LT(norm(sum.high_m - sum.low_m - e.size_m), 0.001) << e.file;
    EXPECT_GT(least_angle_deg(mesh), e.least_angle_deg) << e.file;
  }
}

TEST(MakeMeshes, HeartIsOnePieceWithThreeOpenVessels) {
  const SurfaceMesh heart = load(shipped("heart_10026.obj"));
  EXPECT_EQ(parts(heart, [](std::size_t, std::size_t) { return true; }), 1);
  const auto on_rim = [&](std::size_t t, std::size_t e) {
    return heart.neighbour[t][e] == model::contact::kNoTriangle;
  };
  EXPECT_EQ(parts(heart, on_rim), 3);
  for (std::size_t t = 0; t < heart.triangle.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {  // all at the base, far from the front and the apex
      if (!on_rim(t, e)) continue;
      EXPECT_LT(heart.vertex_m[heart.triangle[t][e]].x, -0.040);
    }
  }
}

TEST(MakeMeshes, HandIsTwoClosedPiecesWithTheFingertipAtTheOrigin) {
  const SurfaceMesh hand = load(shipped("hand_2865.obj"));
  EXPECT_EQ(parts(hand, [](std::size_t, std::size_t) { return true; }), 2);
  EXPECT_NEAR(summarize(hand).low_m.z, 0.0, 0.0002);
  for (const Vec3& p_m : hand.vertex_m) {  // the tip is a ball of 6.5 mm
    if (p_m.z > 0.006) continue;
    EXPECT_NEAR(norm(p_m - Vec3{0, 0, 0.0065}), 0.0065, 0.0001);
  }
}

TEST(MakeMeshes, GumHasEvenTrianglesWhereTheBladeGoes) {
  const SurfaceMesh gum = load(shipped("gum.obj"));
  double sum_m = 0.0;
  int edges = 0;
  for (const TriangleCorners& t : gum.triangle) {
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 &a_m = gum.vertex_m[t[e]], &b_m = gum.vertex_m[t[(e + 1) % 3]];
      if (std::min(a_m.z, b_m.z) < 0.003) continue;
      EXPECT_GT(norm(b_m - a_m), 0.0007);
      EXPECT_LT(norm(b_m - a_m), 0.0024);
      sum_m += norm(b_m - a_m);
      ++edges;
    }
  }
  EXPECT_GT(edges, 3000);
  EXPECT_NEAR(sum_m / edges, 0.0015, 0.0001);
}

TEST(MakeMeshes, CoverIsAPlateAndAGasketThatLiesOnIt) {
  const SurfaceMesh cover = load(shipped("cover.obj"));
  EXPECT_EQ(parts(cover, [](std::size_t, std::size_t) { return true; }), 2);
  std::size_t on_crest = 0;
  for (std::size_t v = 0; v < cover.vertex_m.size(); ++v) {
    const Vec3& p_m = cover.vertex_m[v];
    if (v < 7200 || p_m.z < 0.006) continue;  // the plate's vertices come first
    ++on_crest;
    EXPECT_GT(cover.vertex_normal[v].z, 0.9);
    EXPECT_LT(std::min(std::abs(std::abs(p_m.x) - 0.026), std::abs(std::abs(p_m.y) - 0.036)),
              0.005);
  }
  EXPECT_GT(on_crest, 200u);
  for (std::size_t v = 7200; v < cover.vertex_m.size(); ++v)
    EXPECT_GT(cover.vertex_m[v].z, 0.0) << "the gasket is on the plate, not in it";
}

TEST(MakeMeshes, ToolsStartAtTheOrigin) {
  const SurfaceMesh injector = load(shipped("injector.obj"));
  for (const Vec3& p_m : injector.vertex_m) {  // a blunt ball of 2.5 mm
    if (p_m.z > 0.0025) continue;
    EXPECT_NEAR(norm(p_m - Vec3{0, 0, 0.0025}), 0.0025, 1e-6);
  }
  const SurfaceMesh press = load(shipped("press.obj"));
  for (const Vec3& p_m : press.vertex_m) {  // a ball of 4 mm
    if (p_m.z > 0.006) continue;
    EXPECT_NEAR(norm(p_m - Vec3{0, 0, 0.004}), 0.004, 1e-6);
  }
  const SurfaceMesh blade = load(shipped("blade.obj"));
  int edge = 0;
  for (const Vec3& p_m : blade.vertex_m) {  // below 24 mm only the edge reaches x = 0
    if (p_m.z > 0.0241 || p_m.x < 0.0) continue;
    EXPECT_EQ(norm(Vec3{p_m.x, p_m.y, 0.0}), 0.0);
    ++edge;
  }
  EXPECT_EQ(edge, 6);
}

TEST(MakeMeshes, LiverComesInAnySizeWithTheSameShape) {
  const TempDirectory temp;
  const MeshSummary reference = summarize(load(shipped("liver_3116.obj")));
  for (const std::size_t vertices : {50u, 51u, 64u, 97u, 1000u, 20001u}) {
    const Ran ran =
        run_apart(temp, "tact-make-meshes",
                  "--out " + temp.path() + " --liver --liver-vertices " + std::to_string(vertices));
    ASSERT_EQ(ran.status, 0) << ran.err;
    const SurfaceMesh liver = load(temp.path() + "/liver_" + std::to_string(vertices) + ".obj");
    const MeshSummary sum = summarize(liver);
    EXPECT_EQ(sum.vertices, vertices);
    EXPECT_EQ(sum.triangles, 2 * vertices - 4);
    EXPECT_EQ(sum.boundary_edges, 0u);
    EXPECT_GT(least_angle_deg(liver), 15.0) << vertices;
    EXPECT_NEAR(sum.volume_m3 / reference.volume_m3, 1.0, vertices < 1000 ? 0.2 : 0.02);
  }
}

TEST(MakeMeshes, RefusesBadUsageInOneLine) {
  const TempDirectory temp;
  for (const std::string arguments :
       {"", "--out /nowhere/at/all", "--out . --liver-vertices 49", "--out . --kidney"}) {
    const Ran ran = run_apart(temp, "tact-make-meshes", arguments);
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_EQ(ran.err.rfind("tact-make-meshes: ", 0), 0u) << ran.err;
  }
}

}  // namespace tact::tests::make_meshes_test
