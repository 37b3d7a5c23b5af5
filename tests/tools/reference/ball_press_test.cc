// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/ball_press.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/needs_calculix.h"
#include "tools/reference/calculix/rigid_ball.h"
#include "tools/reference/self_check/block.h"

namespace tact::tools::reference::ball_press_test {

using model::Vec3;

constexpr double kRadius_m = 5e-3;
constexpr Elasticity kTissue{.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45};

TEST(RigidBall, IsRoundOutsideAndHasItsWedgesRightSideOut) {
  const RigidBall ball = make_rigid_ball(kRadius_m);
  double pole = 0.0, back = 0.0;
  for (const WedgeNodes& w : ball.wedge) {
    const auto at = [&](std::size_t k) { return ball.node_m[w[k]]; };
    for (const std::size_t k : {3U, 4U, 5U, 9U, 10U, 11U})
      EXPECT_NEAR(norm(at(k)), kRadius_m, 1e-15);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(norm(at(12 + k) - 0.5 * (at(k) + at(3 + k))), 1e-15) << "the middle of a spoke";
      EXPECT_LT(norm(at(9 + k) - at(3 + k)), norm(at(9 + k) - at(3 + (k + 2) % 3)))
          << "the middle of the edge from corner k to the next";
      pole = std::max(pole, at(3 + k).x);
      back = std::min(back, at(3 + k).x);
    }
    EXPECT_GT(dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)), 0.0) << "its volume";
  }
  EXPECT_EQ(pole, kRadius_m) << "a node in the pole: what touches first";
  EXPECT_LT(back, -0.5 * kRadius_m) << "round the sides, where deep tissue closes in";
}

/// A cylinder, 20 mm wide and 10 mm high, and the problem of a ball pressed on its top.
struct Pressed {
  OrganBody body;
  BallContact ball;
  std::vector<Vec3> displacement_m;
  Vec3 force_N{};
};

Pressed press_cylinder(double depth_m) {
  const auto block = make_block(0.01, 0.01, kTissue);
  EXPECT_TRUE(block) << block.error().message;
  const Circle tip{{0, 0, 0}, {0, 0, -1}, kRadius_m};
  auto body = make_organ_body(block->surface,
                              {.at_m = {},
                               .axis = {},
                               .radius_m = 5e-3,
                               .fine_m = 2.2e-3,
                               .growth = 0.8,
                               .largest_m = 8e-3},
                              block->held);
  EXPECT_TRUE(body) << body.error().message;
  Pressed out{.body = std::move(*body), .ball = {}, .displacement_m = {}};
  out.ball = ball_on(out.body, tip, depth_m);
  ElasticProblem problem{
      .body = &out.body.mesh,
      .material = kTissue,
      .held = out.body.held_node,
      .load = {.direction = tip.axis, .moved = {}, .large_strain = true, .ball = out.ball},
      .reported = nodes_of_faces(out.body, [](std::size_t) { return true; })};
  const auto answer = solve_with_calculix(problem);
  EXPECT_TRUE(answer) << answer.error().message;
  if (!answer) return out;
  out.force_N = answer->force_N;
  out.displacement_m.resize(out.body.mesh.node_m.size());
  for (std::size_t i = 0; i < problem.reported.size(); ++i)
    out.displacement_m[problem.reported[i]] = answer->displacement_m[i];
  return out;
}

using BallPress = tests::NeedsCalculiX;

TEST_F(BallPress, TissueSlidesAroundTheBallAndIsNeverInIt) {
  constexpr double kDepth_m = 3e-3;
  const Pressed p = press_cylinder(kDepth_m);
  ASSERT_FALSE(p.displacement_m.empty());
  const Vec3 centre_m{0, 0, kRadius_m - kDepth_m};
  double nearest_m = 1.0, widest_slide_m = 0.0;
  for (std::uint32_t n = 0; n < p.body.mesh.node_m.size(); ++n) {
    const Vec3& rest_m = p.body.mesh.node_m[n];
    const double away_m = norm(rest_m + p.displacement_m[n] - centre_m);
    if (rest_m.z == 0.0) nearest_m = std::min(nearest_m, away_m);
    if (away_m < 1.01 * kRadius_m)
      widest_slide_m =
          std::max(widest_slide_m, std::hypot(p.displacement_m[n].x, p.displacement_m[n].y));
  }
  EXPECT_GT(nearest_m, 0.995 * kRadius_m);
  EXPECT_LT(nearest_m, 1.005 * kRadius_m);
  EXPECT_GT(widest_slide_m, 0.1e-3) << "nodes that may not slide make it stiffer";
  const double touched_m = touched_radius_m(p.body, p.ball, {0, 0, -1}, p.displacement_m);
  EXPECT_GT(touched_m, 0.5 * kRadius_m);
  EXPECT_LT(touched_m, kRadius_m);
  EXPECT_LT(p.force_N.z, -20e-3) << "the ball pushes down";
  EXPECT_LT(std::hypot(p.force_N.x, p.force_N.y), 0.02 * std::abs(p.force_N.z));
}

TEST_F(BallPress, MayTouchWhatLooksAtItWithinTwoRadii) {
  const auto block = make_block(0.03, 0.03, kTissue);
  ASSERT_TRUE(block) << block.error().message;
  const auto body = make_organ_body(
      block->surface,
      {.at_m = {}, .axis = {}, .radius_m = 8e-3, .fine_m = 2e-3, .growth = 0.5, .largest_m = 8e-3},
      block->held);
  ASSERT_TRUE(body) << body.error().message;
  const BallContact ball = ball_on(*body, {{0, 0, 0}, {0, 0, -1}, kRadius_m}, 1e-3);
  EXPECT_EQ(ball.centre_m, (Vec3{0, 0, kRadius_m})) << "it rests on the site";
  std::set<model::contact::TriangleCorners> listed(ball.face.begin(), ball.face.end());
  for (std::size_t f = 0; f < body->face.size(); ++f) {
    const FaceNodes& n = body->face[f];
    const Vec3 c = centre_m(*body, f);
    const bool near = c.z == 0.0 && std::hypot(c.x, c.y) <= 2.0 * kRadius_m;
    EXPECT_EQ(listed.count({n[0], n[1], n[2]}) > 0, near) << c.x << " " << c.y << " " << c.z;
  }
}

}  // namespace tact::tools::reference::ball_press_test
