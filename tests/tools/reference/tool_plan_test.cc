// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/plan/tool_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/shapes.h"
#include "tools/reference/organ/surface_rays.h"

namespace tact::tools::reference::tool_plan_test {

using model::Vec3;

const model::scene::Scene& liver() {
  static const auto scene =
      model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", {});
  EXPECT_TRUE(scene) << scene.error().message;
  return *scene;
}

TEST(SurfaceRays, GoThroughABall) {
  const auto ball = tests::make_ball(0.01, 4);
  const SurfaceRays rays(ball);
  const auto met = rays.thickness({1e-4, 2e-4, 0.05}, {0, 0, -1});
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->away_m, 0.04, 1e-4);
  EXPECT_NEAR(met->thick_m, 0.02, 2e-4);
  const auto inside = rays.thickness({1e-4, 2e-4, 0.004}, {0, 0, -1});
  ASSERT_TRUE(inside);
  EXPECT_NEAR(inside->away_m, -0.006, 1e-4) << "a start inside lies behind the way in";
  EXPECT_FALSE(rays.thickness({0.02, 0, 0.05}, {0, 0, -1}));
  EXPECT_FALSE(rays.thickness({0, 0, 0.05}, {0, 0, 1})) << "behind the start";
}

TEST(ToolPlan, PressesAlongTheSlidesOfTheHand) {
  const auto plan = tool_plan_of(liver(), {}, {}, 1);
  ASSERT_TRUE(plan) << plan.error().message;
  const auto& middle = plan->places[1];  // of one slide of 20 mm along y
  const auto& end = plan->places[2];
  EXPECT_EQ(name_of(plan->places[0]) + ", " + name_of(middle) + ", " + name_of(end),
            "hand's, slid 10 mm, slid 20 mm");
  EXPECT_NEAR(norm(end.slid_m - Vec3{0, 0.020, 0}), 0.0, 1e-12);
  for (const auto* place : {&middle, &end}) {
    EXPECT_FALSE(place->vertex);
    EXPECT_EQ(place->direction, plan->places[0].direction);
    EXPECT_EQ(place->orientation, model::Quat{});
    const Vec3 off_m = place->point_m - plan->places[0].point_m - place->slid_m;
    EXPECT_NEAR(norm(off_m - Vec3{0, 0, off_m.z}), 0.0, 1e-12) << "down to where it first touches";
  }
  EXPECT_EQ(tool_plan_of(liver(), {1985}, {}, 1)->places.size(), 2U) << "those asked for alone";
  model::scene::Scene gripped = liver();
  for (auto& point : gripped.hand.path) point.grip_ratio = 1.0;
  EXPECT_EQ(tool_plan_of(gripped, {}, {}, 1)->places.size(), 1 + kUnseenPlaces)
      << "a pull, no slide";
}

TEST(ToolPlan, PressesAtTheHandsSiteAndAtSixPlacesThatNoFitUses) {
  const auto plan = tool_plan_of(liver(), {}, {}, 1);
  ASSERT_TRUE(plan) << plan.error().message;
  constexpr std::size_t kOnTheWay = 3;  // the site and its slide
  ASSERT_EQ(plan->places.size(), kOnTheWay + kUnseenPlaces);
  EXPECT_FALSE(plan->places[0].vertex);
  EXPECT_NEAR(norm(plan->places[0].point_m - Vec3{0, 0, 0.03}), 0.0, 1e-12) << "of the mesh";
  EXPECT_EQ(plan->places[0].orientation, model::Quat{});
  std::set<std::size_t> fitted, chosen;
  for (const auto& site : liver().reference_sites)
    if (!site.held_out) fitted.insert(site.vertex);
  for (std::size_t i = kOnTheWay; i < plan->places.size(); ++i) {
    const auto& place = plan->places[i];
    EXPECT_EQ(fitted.count(*place.vertex), 0U);
    EXPECT_TRUE(chosen.insert(*place.vertex).second) << "each once";
    EXPECT_GE(dot(place.direction, {0, 0, -1}), 0.5);
    const Vec3 turned = rotate(place.orientation, {0, 0, -1});
    EXPECT_NEAR(norm(turned - place.direction), 0.0, 1e-12) << "the tool comes along its way";
    for (const std::size_t other : fitted)
      EXPECT_GT(norm(plan->organ.surface.vertex_m[other] - place.point_m), 0.01) << "spread";
  }
  const auto again = tool_plan_of(liver(), {}, {}, 1);
  for (std::size_t i = 0; i < plan->places.size(); ++i)
    EXPECT_EQ(plan->places[i].vertex, again->places[i].vertex);
}

TEST(ToolPlan, FirstTouchesAtDepthZero) {
  const auto plan = tool_plan_of(liver(), {1985, 2478}, {}, 1);
  ASSERT_TRUE(plan) << plan.error().message;
  const auto presses = presses_of(*plan);
  ASSERT_EQ(presses.size(), 6U) << "three places at two levels";
  for (std::size_t i = 1; i < 3; ++i) {
    double beyond_m = -1.0;
    const auto& surface = plan->organ.surface;
    for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
      const auto& c = surface.triangle[t];
      if (dot(surface.face_normal[t], presses[i].direction) > 0.0) continue;
      constexpr int kParts = 20;
      for (int p = 0; p <= kParts; ++p)
        for (int q = 0; q <= kParts - p; ++q) {
          const double u = double(p) / kParts, v = double(q) / kParts;
          const Vec3 at_m = u * surface.vertex_m[c[0]] + v * surface.vertex_m[c[1]] +
                            (1.0 - u - v) * surface.vertex_m[c[2]];
          beyond_m = std::max(beyond_m, reach_beyond(presses[i], at_m).beyond_m);
        }
    }
    EXPECT_NEAR(beyond_m, 0.0, 0.03e-3) << i;
  }
}

TEST(ToolPlan, NamesWhatCannotBePressed) {
  EXPECT_NE(tool_plan_of(liver(), {99999}, {}, 1).error().message.find("site 99999"),
            std::string::npos);
  EXPECT_NE(tool_plan_of(liver(), {125}, {}, 1).error().message.find("held"), std::string::npos);
  EXPECT_NE(tool_plan_of(liver(), {}, {0.002, 0.001}, 1).error().message.find("--depths"),
            std::string::npos);
  model::scene::Scene bare = liver();
  bare.elastic.reset();
  EXPECT_NE(tool_plan_of(bare, {}, {}, 1).error().message.find("[elastic]"), std::string::npos);
}

TEST(ToolPlan, AnErrorIsWhatIsLeftOfTheChangeBetweenTwoLevels) {
  const auto plan = tool_plan_of(liver(), {1985}, {0.002}, 1);
  ASSERT_TRUE(plan) << plan.error().message;
  const auto solved = [](double force_N) {
    return std::vector<ground_truth::ToolCase>{
        {.depth_m = 0.002, .force_N = force_N, .sphere_N = {0.0, force_N}}};
  };
  const auto data = assemble(*plan, {solved(1.0), solved(2.0), solved(1.03), solved(1.97)}, "s");
  EXPECT_NEAR(data.places[0].cases[0].force_error_ratio, 0.03 * 7.0 / 3.0, 1e-12);
  EXPECT_NEAR(data.places[1].cases[0].force_error_ratio, 0.015 * 7.0 / 3.0, 1e-12);
  EXPECT_EQ(data.places[1].cases[0].force_N, 2.0);
}

}  // namespace tact::tools::reference::tool_plan_test
