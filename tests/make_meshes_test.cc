// The shipped meshes: what they must be, and that the generator gives the same bytes again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/obj.h"
#include "tests/mesh_files.h"

namespace tact::tests {
namespace {

using model::MeshSummary;
using model::SurfaceMesh;
using model::TriangleCorners;
using model::Vec3;

std::string shipped(const std::string& name) {
  return std::string(TACT_SOURCE_DIR) + "/model/scenes/meshes/" + name;
}

SurfaceMesh load(const std::string& path) {
  auto obj = model::load_obj(path, 0.001);
  EXPECT_TRUE(obj.has_value()) << (obj ? "" : obj.error().sentence);
  if (!obj) return {};
  EXPECT_FALSE(obj->flipped);
  EXPECT_EQ(obj->welded_vertices + obj->unused_vertices, 0u);
  return std::move(obj->mesh);
}

// V - E + F: 2 for a ball, 0 for a ring. A closed surface has E = 3 F / 2.
int euler(const MeshSummary& sum) {
  return static_cast<int>(sum.vertices) - static_cast<int>(sum.triangles) / 2;
}

double least_angle_deg(const SurfaceMesh& mesh) {
  double least_rad = 4.0;
  for (const TriangleCorners& t : mesh.triangle) {
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 a_m = mesh.vertex_m[t[(e + 1) % 3]] - mesh.vertex_m[t[e]];
      const Vec3 b_m = mesh.vertex_m[t[(e + 2) % 3]] - mesh.vertex_m[t[e]];
      least_rad = std::min(least_rad, std::atan2(norm(cross(a_m, b_m)), dot(a_m, b_m)));
    }
  }
  return least_rad * 180.0 / M_PI;
}

bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = cross(b - a, c - a);
  const double from = dot(p - a, n), to = dot(q - a, n);
  if (!(from * to < 0.0)) return false;
  const Vec3 x = p + (from / (from - to)) * (q - p);
  return dot(cross(b - a, x - a), n) > 0.0 && dot(cross(c - b, x - b), n) > 0.0 &&
         dot(cross(a - c, x - c), n) > 0.0;
}

// Edges of one triangle that pass through another one with no corner in common.
int self_crossings(const SurfaceMesh& mesh) {
  const auto at = [&](std::uint32_t t, std::size_t e) -> const Vec3& {
    return mesh.vertex_m[mesh.triangle[t][e]];
  };
  const auto low_y = [&](std::uint32_t t) {
    return std::min({at(t, 0).y, at(t, 1).y, at(t, 2).y});
  };
  const auto high_y = [&](std::uint32_t t) {
    return std::max({at(t, 0).y, at(t, 1).y, at(t, 2).y});
  };
  std::vector<std::uint32_t> order(mesh.triangle.size());
  for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = t;
  std::sort(order.begin(), order.end(), [&](auto s, auto t) { return low_y(s) < low_y(t); });
  int found = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t s = order[i];
    for (std::size_t j = i + 1; j < order.size() && low_y(order[j]) <= high_y(s); ++j) {
      const std::uint32_t t = order[j];
      const TriangleCorners &a = mesh.triangle[s], &b = mesh.triangle[t];
      if (std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end()) continue;
      for (std::size_t e = 0; e < 3; ++e) {
        found += crosses(at(s, e), at(s, (e + 1) % 3), at(t, 0), at(t, 1), at(t, 2));
        found += crosses(at(t, e), at(t, (e + 1) % 3), at(s, 0), at(s, 1), at(s, 2));
      }
    }
  }
  return found;
}

TEST(MakeMeshes, GivesTheShippedFilesByteForByte) {
  const TempDirectory temp;
  const Ran ran = run_apart(temp, "tact-make-meshes", "--out " + temp.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  for (const std::string name : {"liver_3116.obj", "forceps_174.obj"}) {
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
    if (r_m > 0.004) {
      EXPECT_GT(dot(liver.vertex_normal[v], Vec3{p_m.x, p_m.y, 0}), 0.0);
    }
  }
  EXPECT_GT(inside, 40);
}

TEST(MakeMeshes, LiverHasNoSharpCrease) {
  const SurfaceMesh liver = load(shipped("liver_3116.obj"));
  double sharpest = 1.0;
  for (std::size_t t = 0; t < liver.triangle.size(); ++t) {
    for (const std::uint32_t across : liver.neighbour[t]) {
      sharpest = std::min(sharpest, dot(liver.face_normal[t], liver.face_normal[across]));
    }
  }
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
       {"", "--out /nowhere/at/all", "--out . --liver-vertices 49", "--out . --heart"}) {
    const Ran ran = run_apart(temp, "tact-make-meshes", arguments);
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_EQ(ran.err.rfind("tact-make-meshes: ", 0), 0u) << ran.err;
  }
}

}  // namespace
}  // namespace tact::tests
