// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/turn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/shapes.h"

namespace tact::model::mesh::turn_test {

void expect_near(const Vec3& a, const Vec3& b, double within) { EXPECT_LT(norm(a - b), within); }

TEST(Turn, IsRightHandedAboutItsAxisInDegrees) {
  expect_near(rotate(turn_of({90, 0, 0}), {0, 1, 0}), {0, 0, 1}, 1e-15);
  expect_near(rotate(turn_of({0, 0, -90}), {1, 0, 0}), {0, -1, 0}, 1e-15);
  expect_near(rotate(turn_of({0, 0, 0}), {1, 2, 3}), {1, 2, 3}, 0.0 + 1e-15);
}

TEST(Turn, ComesBackAsTheSameDegreesTheShorterWayRound) {
  for (const Vec3 v : {Vec3{10, -20, 30}, {179, 0, 0}, {0, 0, 0}, {0, -90, 0}})
    expect_near(rotation_deg_of(turn_of(v)), v, 1e-9);
  expect_near(rotation_deg_of(turn_of({270, 0, 0})), {-90, 0, 0}, 1e-9);
}

TEST(Turn, BringsOneDirectionToAnother) {
  const Vec3 from = normalized(Vec3{1, 2, 3});
  for (const Vec3 to : {normalized(Vec3{-3, 1, 0.2}), from, -from, Vec3{0, 0, 1}}) {
    const Quat turn = turn_between(from, to);
    expect_near(rotate(turn, from), to, 1e-12);
    EXPECT_NEAR(2.0 * std::acos(std::min(1.0, turn.w)),
                std::acos(std::clamp(dot(from, to), -1.0, 1.0)), 1e-7);
  }
  expect_near(rotate(turn_between({0, 0, 1}, {0, 0, -1}), {0, 0, 1}), {0, 0, -1}, 1e-12);
}

TEST(Turn, TakesTheNormalsOfASurfaceAlong) {
  SurfaceMesh turned = tests::make_ball(0.03, 2);
  const SurfaceMesh before = turned;
  const Quat by = turn_of({20, -40, 70});
  turn(turned, by);
  const auto again = make_surface_mesh(turned.vertex_m, turned.triangle);
  ASSERT_TRUE(again);
  for (std::size_t t = 0; t < turned.triangle.size(); ++t) {
    expect_near(turned.face_normal[t], again->face_normal[t], 1e-12);
    expect_near(turned.record[t].corner_m[1], rotate(by, before.record[t].corner_m[1]), 1e-15);
    expect_near(turned.record[t].normal, again->face_normal[t], 1e-12);
  }
  for (std::size_t v = 0; v < turned.vertex_m.size(); ++v)
    expect_near(turned.vertex_normal[v], again->vertex_normal[v], 1e-12);
}

}  // namespace tact::model::mesh::turn_test
