// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/calculix/calculix_deck.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tools/reference/calculix/rigid_ball.h"

namespace tact::tools::reference::calculix_deck_test {

using model::Vec3;

/// One tetrahedron, 10 mm long, its straight edges halved.
model::fem::TetMesh tetrahedron() {
  model::fem::TetMesh mesh{.node_m = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}},
                           .element = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}};
  for (const auto& [a, b] : model::fem::kTetEdge)
    mesh.node_m.push_back(0.5 * (mesh.node_m[a] + mesh.node_m[b]));
  return mesh;
}

std::string deck_with_ball(double depth_m, std::vector<model::contact::TriangleCorners> faces) {
  const model::fem::TetMesh mesh = tetrahedron();
  const BallContact ball{
      .radius_m = 5e-3, .centre_m = {0, 0, -5e-3}, .along_m = depth_m, .face = std::move(faces)};
  return deck_of({.body = &mesh,
                  .material = {.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45},
                  .held = {3},
                  .load = {.direction = {0, 0, 1}, .moved = {}, .large_strain = true, .ball = ball},
                  .reported = {0}});
}

bool has(const std::string& deck, const std::string& lines) {
  return deck.find("\n" + lines + "\n") != std::string::npos;
}

TEST(CalculixDeck, ABallGoesByATenthOfItsRadiusAtATime) {
  // CalculiX keeps the direction of a contact through a step.
  EXPECT_TRUE(has(deck_with_ball(10e-3, {{0, 1, 2}}), "*STATIC\n0.025,1.,1e-5,0.05"));
  EXPECT_TRUE(has(deck_with_ball(1e-3, {{0, 1, 2}}), "*STATIC\n0.1,1.,1e-5,0.2"));
  EXPECT_TRUE(has(deck_with_ball(10e-3, {{0, 1, 2}}), "BALL,1,1,10\nBALL,2,3"));
}

TEST(CalculixDeck, NamesTheElementAndTheNumberOfEveryFaceThatMayBeTouched) {
  // CalculiX manual 6.2: face 1 is 1-2-3, 2 is 1-4-2, 3 is 2-4-3, 4 is 3-4-1; in any order here.
  EXPECT_TRUE(has(deck_with_ball(1e-3, {{2, 1, 0}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}),
                  "*SURFACE,NAME=TOUCHED,TYPE=ELEMENT\n1,S1\n1,S2\n1,S3\n1,S4"));
}

TEST(CalculixDeck, TheBallRestsWhereItIsPutInMillimetres) {
  // The deck's x is the direction of the load; nodes of the body are 1 to 10.
  const std::string deck = deck_with_ball(1e-3, {{0, 1, 2}});
  const RigidBall ball = make_rigid_ball(5e-3);
  const Vec3 first_mm = ball.node_m.front() * 1e3 + Vec3{-5, 0, 0};
  const auto at = deck.find("*NODE,NSET=BALL\n11,");
  ASSERT_NE(at, std::string::npos);
  double x = 0.0;
  ASSERT_EQ(std::sscanf(deck.c_str() + at, "*NODE,NSET=BALL\n11,%lf", &x), 1);
  EXPECT_NEAR(x, first_mm.x, 1e-9);
}

TEST(CalculixDeck, MovedNodesNeedNoContact) {
  const model::fem::TetMesh mesh = tetrahedron();
  const std::string deck =
      deck_of({.body = &mesh,
               .material = {.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45},
               .held = {3},
               .load = {.direction = {0, 0, 1}, .moved = {{1, 2e-3}}, .sideways_held = true},
               .reported = {0}});
  EXPECT_TRUE(has(deck, "*STEP\n*STATIC\n*BOUNDARY\n2,1,1,2\n2,2,3"));
  EXPECT_EQ(deck.find("CONTACT"), std::string::npos);
  EXPECT_EQ(deck.find("BALL"), std::string::npos);
}

}  // namespace tact::tools::reference::calculix_deck_test
