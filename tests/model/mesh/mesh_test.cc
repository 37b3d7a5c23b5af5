// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "model/mesh/mesh_defect.h"
#include "tests/support/shapes.h"

namespace tact::model::mesh::mesh_test {

using tests::make_ball;
using tests::make_plate;

constexpr double kPi = std::numbers::pi;

const std::vector<Vec3> kCubeVertices{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const std::vector<contact::TriangleCorners> kCubeTriangles{
    {0, 3, 2}, {0, 2, 1}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
    {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};

SurfaceMesh make_cube() { return *make_surface_mesh(kCubeVertices, kCubeTriangles); }

MeshDefect defect_of(const std::vector<Vec3>& vertices,
                     const std::vector<contact::TriangleCorners>& triangles) {
  const SurfaceOrDefect built = build_surface(vertices, triangles);
  const auto* defect = std::get_if<MeshDefect>(&built);
  EXPECT_NE(defect, nullptr);
  return defect != nullptr ? *defect : MeshDefect{};
}

std::string message_of(const std::vector<Vec3>& vertices,
                       const std::vector<contact::TriangleCorners>& triangles) {
  const auto mesh = make_surface_mesh(vertices, triangles);
  EXPECT_FALSE(mesh.has_value());
  return mesh ? "" : mesh.error().message;
}

void expect_sound(const SurfaceMesh& mesh) {
  const contact::SurfaceView view = mesh.view();
  ASSERT_EQ(view.neighbour.size(), view.triangle.size());
  for (std::uint32_t t = 0; t < view.triangle.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t across = view.neighbour[t][e];
      if (across == contact::kNoTriangle) continue;
      ASSERT_LT(across, view.triangle.size());
      // The neighbour runs along the same edge the other way, and knows this triangle there.
      const std::uint32_t a = view.triangle[t][e], b = view.triangle[t][(e + 1) % 3];
      int matches = 0;
      for (std::size_t f = 0; f < 3; ++f) {
        const contact::TriangleCorners& other = view.triangle[across];
        matches += other[f] == b && other[(f + 1) % 3] == a && view.neighbour[across][f] == t;
      }
      ASSERT_EQ(matches, 1);
    }
  }
}

void expect_complete_fans(const SurfaceMesh& mesh) {
  ASSERT_EQ(mesh.fan_start.size(), mesh.vertex_m.size() + 1);
  ASSERT_EQ(mesh.fan_start.front(), 0u);
  ASSERT_EQ(mesh.fan_start.back(), mesh.fan.size());
  ASSERT_EQ(mesh.fan.size(), 3 * mesh.triangle.size());
  for (std::uint32_t v = 0; v < mesh.vertex_m.size(); ++v) {
    std::set<std::uint32_t> seen;
    for (std::uint32_t i = mesh.fan_start[v]; i < mesh.fan_start[v + 1]; ++i) {
      const contact::TriangleCorners& t = mesh.triangle[mesh.fan[i]];
      ASSERT_NE(std::find(t.begin(), t.end(), v), t.end());
      seen.insert(mesh.fan[i]);
    }
    // No triangle twice; with 3 m places in all, none is missing either.
    ASSERT_EQ(seen.size(), mesh.fan_start[v + 1] - mesh.fan_start[v]);
  }
}

void expect_records_of(const SurfaceMesh& mesh) {
  ASSERT_EQ(mesh.record.size(), mesh.triangle.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const contact::TriangleRecord& record = mesh.record[t];
    EXPECT_EQ(record.normal, mesh.face_normal[t]);
    EXPECT_EQ(record.neighbour, mesh.neighbour[t]);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.triangle[t][c];
      EXPECT_EQ(record.corner_m[c], mesh.vertex_m[v]);
      EXPECT_EQ(record.fan_start[c], mesh.fan_start[v]);
      EXPECT_EQ(record.fan_count[c], mesh.fan_start[v + 1] - mesh.fan_start[v]);
    }
  }
}

TEST(Mesh, RecordsOfItsTrianglesMoveWithIt) {
  SurfaceMesh cube = make_cube();
  expect_records_of(cube);
  shift(cube, {0.1, -0.2, 0.3});
  expect_records_of(cube);
  for (const contact::TriangleRecord& record : cube.record)
    EXPECT_EQ(record.on_boundary, (std::array<bool, 3>{})) << "a closed surface has no rim";
  const SurfaceMesh triangle = *make_surface_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  expect_records_of(triangle);
  EXPECT_EQ(triangle.record[0].on_boundary, (std::array<bool, 3>{true, true, true}));
}

TEST(Mesh, NeighboursKnowEachOther) {
  expect_sound(make_cube());
  expect_sound(make_ball(1.0, 3));
  expect_sound(make_plate(1.0, 7));
}

TEST(Mesh, FansHoldEveryTriangleOfAVertexOnce) {
  expect_complete_fans(make_cube());
  expect_complete_fans(make_ball(1.0, 3));
  expect_complete_fans(make_plate(1.0, 7));
}

TEST(Mesh, CubeHasTheAreaAndVolumeOfACube) {
  const MeshSummary sum = summarize(make_cube());
  EXPECT_EQ(sum.vertices, 8u);
  EXPECT_EQ(sum.triangles, 12u);
  EXPECT_EQ(sum.boundary_edges, 0u);
  EXPECT_DOUBLE_EQ(sum.area_m2, 6.0);
  EXPECT_DOUBLE_EQ(sum.volume_m3, 1.0);
  EXPECT_EQ(sum.low_m, (Vec3{0, 0, 0}));
  EXPECT_EQ(sum.high_m, (Vec3{1, 1, 1}));
}

TEST(Mesh, VolumeKeepsItsDigitsFarFromTheOrigin) {
  std::vector<Vec3> far = kCubeVertices;
  for (Vec3& p : far) p += Vec3{1e6, -1e6, 1e6};
  EXPECT_NEAR(summarize(*make_surface_mesh(far, kCubeTriangles)).volume_m3, 1.0, 1e-9);
}

TEST(Mesh, BallVolumeTendsToTheBallFromBelowWithTheSquareOfTheEdge) {
  const double ball_m3 = 4.0 / 3.0 * kPi;
  const double coarse_m3 = ball_m3 - summarize(make_ball(1.0, 3)).volume_m3;
  const double fine_m3 = ball_m3 - summarize(make_ball(1.0, 4)).volume_m3;
  EXPECT_GT(fine_m3, 0.0);
  EXPECT_GT(coarse_m3 / fine_m3, 3.8);
  EXPECT_LT(coarse_m3 / fine_m3, 4.2);
}

TEST(Mesh, PlateHasABoundaryOfFourSides) {
  const MeshSummary sum = summarize(make_plate(2.0, 7));
  EXPECT_EQ(sum.boundary_edges, 4u * 7u);
  EXPECT_NEAR(sum.area_m2, 4.0, 1e-12);
}

TEST(Mesh, NormalsAreUnitVectors) {
  for (const SurfaceMesh& mesh : {make_cube(), make_ball(0.05, 3), make_plate(1.0, 3)}) {
    for (const Vec3& n : mesh.face_normal) ASSERT_NEAR(norm(n), 1.0, 1e-12);
    for (const Vec3& n : mesh.vertex_normal) ASSERT_NEAR(norm(n), 1.0, 1e-12);
  }
}

TEST(Mesh, NormalsOfABallPointOutward) {
  const SurfaceMesh ball = make_ball(0.05, 4);
  for (std::size_t v = 0; v < ball.vertex_m.size(); ++v)
    ASSERT_GT(dot(ball.vertex_normal[v], normalized(ball.vertex_m[v])), 0.999);
  for (std::size_t t = 0; t < ball.triangle.size(); ++t)
    ASSERT_GT(dot(ball.face_normal[t], normalized(ball.vertex_m[ball.triangle[t][0]])), 0.99);
}

TEST(Mesh, VertexNormalsAreWeightedWithAngles) {
  // However its faces are cut, each corner of a cube sees three right angles: the normal is the
  // diagonal. Weights by area or by number would lean towards the faces with two triangles.
  const SurfaceMesh cube = make_cube();
  for (std::size_t v = 0; v < 8; ++v) {
    const Vec3 diagonal = normalized(cube.vertex_m[v] - Vec3{0.5, 0.5, 0.5});
    EXPECT_NEAR(norm(cube.vertex_normal[v] - diagonal), 0.0, 1e-12);
  }
}

TEST(Mesh, LeavesAnUnusedVertexWithAnEmptyFanAndAUnitNormal) {
  std::vector<Vec3> vertices = kCubeVertices;
  vertices.insert(vertices.begin() + 8, {5, 5, 5});
  const SurfaceMesh mesh = *make_surface_mesh(vertices, kCubeTriangles);
  expect_complete_fans(mesh);
  EXPECT_EQ(mesh.fan_start[8], mesh.fan_start[9]);
  EXPECT_DOUBLE_EQ(norm(mesh.vertex_normal[8]), 1.0);
}

TEST(Mesh, SheetsFoldedFlatStillHaveUnitNormals) {
  const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const SurfaceMesh pillow = *make_surface_mesh(vertices, {{0, 1, 2}, {0, 2, 1}});
  EXPECT_EQ(summarize(pillow).boundary_edges, 0u);
  for (const Vec3& n : pillow.vertex_normal) EXPECT_DOUBLE_EQ(norm(n), 1.0);
}

TEST(Mesh, RefusesAFaceThatNamesAMissingVertex) {
  auto triangles = kCubeTriangles;
  triangles[7][2] = 8;
  EXPECT_EQ(defect_of(kCubeVertices, triangles).flaw, MeshFlaw::kMissingVertex);
  EXPECT_EQ(message_of(kCubeVertices, triangles),
            "triangle 7 names a vertex that does not exist; export the mesh again");
}

TEST(Mesh, RefusesACornerThatIsNotFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    auto vertices = kCubeVertices;
    vertices[6].y = bad;  // first used by triangle 2
    const MeshDefect defect = defect_of(vertices, kCubeTriangles);
    EXPECT_EQ(defect.flaw, MeshFlaw::kNotFinite);
    EXPECT_EQ(defect.triangle, 2u);
  }
}

TEST(Mesh, RefusesATriangleWithARepeatedCorner) {
  auto triangles = kCubeTriangles;
  triangles[5] = {1, 1, 2};
  EXPECT_EQ(defect_of(kCubeVertices, triangles).flaw, MeshFlaw::kRepeatedCorner);
  EXPECT_EQ(defect_of(kCubeVertices, triangles).triangle, 5u);
}

TEST(Mesh, RefusesCollinearCornersEvenWhenRoundingHidesThem) {
  const Vec3 from{0.1, 0.7, 0.3}, along{0.3, 0.1, 0.7};
  const std::vector<Vec3> line{from, from + along / 3.0, from + along};
  ASSERT_GT(norm(cross(line[1] - line[0], line[2] - line[0])), 0.0);  // rounding left something
  EXPECT_EQ(defect_of(line, {{0, 1, 2}}).flaw, MeshFlaw::kZeroArea);
  const std::vector<Vec3> vast{{0, 0, 0}, {1e200, 0, 0}, {0, 1e200, 0}};  // the area overflows
  EXPECT_EQ(defect_of(vast, {{0, 1, 2}}).flaw, MeshFlaw::kZeroArea);
}

TEST(Mesh, AcceptsASliverThatIsHonest) {
  const std::vector<Vec3> sliver{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-7, 0}};
  EXPECT_TRUE(make_surface_mesh(sliver, {{0, 1, 2}}).has_value());
  const std::vector<Vec3> speck{{0, 0, 0}, {1e-12, 0, 0}, {0, 1e-12, 0}};
  EXPECT_TRUE(make_surface_mesh(speck, {{0, 1, 2}}).has_value());
}

TEST(Mesh, RefusesAnEdgeWithThreeTriangles) {
  const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  const MeshDefect defect = defect_of(vertices, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_EQ(defect.flaw, MeshFlaw::kCrowdedEdge);
  EXPECT_EQ(defect.triangle, 2u);
  EXPECT_EQ(defect.other, 0u);
  EXPECT_EQ(std::set({defect.from, defect.to}), std::set({0u, 1u}));
}

TEST(Mesh, RefusesTwoTrianglesInTheSameDirectionOnAnEdge) {
  auto triangles = kCubeTriangles;
  std::swap(triangles[9][1], triangles[9][2]);
  const MeshDefect defect = defect_of(kCubeVertices, triangles);
  EXPECT_EQ(defect.flaw, MeshFlaw::kSameDirection);
  EXPECT_EQ(message_of(kCubeVertices, triangles),
            "triangle 9 faces the other way than its neighbour; tact-mesh FILE --out NEW.obj turns "
            "faces as their neighbours");
}

TEST(Mesh, RefusesADoubledTriangle) {
  auto triangles = kCubeTriangles;
  triangles.push_back(triangles[4]);
  const MeshDefect defect = defect_of(kCubeVertices, triangles);
  EXPECT_EQ(defect.flaw, MeshFlaw::kCrowdedEdge);
  EXPECT_EQ(defect.triangle, 12u);
  EXPECT_EQ(defect.other, 4u);
}

TEST(Mesh, NamesTheEarliestOfSeveralBadEdges) {
  auto triangles = kCubeTriangles;
  triangles.push_back(triangles[2]);  // at high vertices, found last
  triangles.push_back(triangles[0]);
  EXPECT_EQ(defect_of(kCubeVertices, triangles).triangle, 12u);
}

TEST(Mesh, RefusesAMeshWithoutTriangles) {
  EXPECT_EQ(message_of(kCubeVertices, {}), "the mesh has no triangles; give it at least one");
  EXPECT_EQ(message_of({}, {}), "the mesh has no triangles; give it at least one");
  EXPECT_FALSE(make_surface_mesh({}, {{0, 1, 2}}).has_value());
}

TEST(Mesh, SurvivesAVertexWithVeryManyTriangles) {
  // A quadratic search for neighbours would take minutes here.
  constexpr std::uint32_t kSpokes = 200'000;
  std::vector<Vec3> vertices{{0, 0, 0}};
  std::vector<contact::TriangleCorners> triangles;
  for (std::uint32_t i = 0; i < kSpokes; ++i) {
    const double a_rad = 2.0 * kPi * i / kSpokes;
    vertices.push_back({std::cos(a_rad), std::sin(a_rad), 0});
    triangles.push_back({0, i + 1, (i + 1) % kSpokes + 1});
  }
  const auto disc = make_surface_mesh(vertices, triangles);
  ASSERT_TRUE(disc.has_value());
  EXPECT_EQ(summarize(disc.value()).boundary_edges, kSpokes);
  EXPECT_NEAR(summarize(disc.value()).area_m2, kPi, 1e-6);
}

TEST(Mesh, EveryFlawHasACauseAndARemedy) {
  for (int i = 0; i <= static_cast<int>(MeshFlaw::kCrowdedEdge); ++i) {
    EXPECT_NE(std::string(what(static_cast<MeshFlaw>(i))), "is unsound");
    EXPECT_FALSE(std::string(remedy(static_cast<MeshFlaw>(i))).empty());
  }
}

}  // namespace tact::model::mesh::mesh_test
