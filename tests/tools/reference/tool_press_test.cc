// SPDX-License-Identifier: Apache-2.0
// Several spheres pressed by finite elements, against answers that are known otherwise.
#include "tools/reference/press/tool_press.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/reference/plan/reference_plan.h"
#include "tools/reference/press/half_space.h"
#include "tools/reference/self_check/block.h"

namespace tact::tools::reference::tool_press_test {

using model::Vec3;

constexpr Elasticity kTissue{.youngs_modulus_Pa = 2000.0, .poisson_ratio = 0.4};

constexpr double kBar = 0.04;  // of the roughest mesh, which solves in seconds

/// So large that it is a half-space: 0.3 m round and deep.
Organ large_block() {
  auto organ = make_block(0.3, 0.3, kTissue);
  EXPECT_TRUE(organ) << organ.error().message;
  return std::move(*organ);
}

TEST(ToolPress, OfOneSphereIsSneddons) {
  const ToolPress press{.direction = {0, 0, -1},
                        .sphere = {{.centre_m = {0, 0, 4e-3}, .radius_m = 4e-3}},
                        .depths_m = {1e-3, 2e-3, 5e-3, 10e-3},
                        .level = kRoughLevel};
  const auto cases = solve(large_block(), press);
  ASSERT_TRUE(cases) << cases.error().message;
  ASSERT_EQ(cases->size(), 4U);
  for (const auto& c : *cases) {
    const double known_N = sphere_force_N(kTissue, 4e-3, c.depth_m);
    EXPECT_NEAR(c.force_N, known_N, kBar * known_N) << c.depth_m;
    EXPECT_NEAR(c.sphere_N[0], c.force_N, 1e-12);
  }
}

TEST(ToolPress, OfOneSphereOnTheLiverIsWhatCalculixFinds) {
  const auto scene = model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", {});
  ASSERT_TRUE(scene) << scene.error().message;
  const auto plan = plan_of(*scene);
  ASSERT_TRUE(plan) << plan.error().message;
  const auto known =
      ground_truth::read_reference(TACT_SOURCE_DIR "/tests/data/reference/liver.json");
  ASSERT_TRUE(known) << known.error().message;
  const ground_truth::SolvedSite& site = known->sites[2];
  ASSERT_EQ(site.vertex, 2780U) << "far from what is held: it gives most";
  const double R =
      known->tool_radius_m;  // NOLINT(readability-identifier-naming): the symbol of the equation
  ToolPress press{.direction = site.direction,
                  .sphere = {{.centre_m = site.point_m - R * site.direction, .radius_m = R}},
                  .depths_m = {},
                  .level = kRoughLevel};
  std::vector<double> known_N;
  for (const auto& c : site.cases) {
    if (c.large_strain || !c.is_press()) continue;
    press.depths_m.push_back(c.depth_m);
    known_N.push_back(c.force_N);
  }
  const auto cases = solve(plan->organ, press);
  ASSERT_TRUE(cases) << cases.error().message;
  for (std::size_t i = 0; i < cases->size(); ++i)
    EXPECT_NEAR((*cases)[i].force_N, known_N[i], kBar * known_N[i]) << press.depths_m[i];
}

TEST(ToolPress, OfTwoSpheresCouplesThem) {
  // Boundary elements by others: alone they would feel 35 and 17 % more.
  const double first_m = 0.002872, second_m = 0.003423,
               R = 3.66e-3;  // NOLINT(readability-identifier-naming): the symbol of the equation
  const ToolPress press{
      .direction = {0, 0, -1},
      .sphere = {{.centre_m = {0.006714, -0.005797, R + second_m - first_m}, .radius_m = R},
                 {.centre_m = {-0.000104, -0.003136, R}, .radius_m = R}},
      .depths_m = {second_m},
      .level = kRoughLevel};
  const auto cases = solve(large_block(), press);
  ASSERT_TRUE(cases) << cases.error().message;
  const auto& sphere_N = cases->front().sphere_N;
  EXPECT_NEAR(sphere_N[0], 0.020165, kBar * 0.020165);
  EXPECT_NEAR(sphere_N[1], 0.029695, kBar * 0.029695);
  EXPECT_NEAR(cases->front().force_N, sphere_N[0] + sphere_N[1], 1e-12);
}

TEST(ToolPress, ReachesAsFarAsItsLowestSphere) {
  const ToolPress press{.direction = {0, 0, -1},
                        .sphere = {{.centre_m = {-5e-3, 0, 4e-3}, .radius_m = 4e-3},
                                   {.centre_m = {5e-3, 0, 3e-3}, .radius_m = 4e-3}},
                        .depths_m = {1e-3},
                        .level = 1};
  EXPECT_NEAR(reach_beyond(press, {-5e-3, 0, 0}).beyond_m, 0.0, 1e-15);
  EXPECT_NEAR(reach_beyond(press, {5e-3, 0, 0}).beyond_m, 1e-3, 1e-15);
  EXPECT_EQ(reach_beyond(press, {5e-3, 0, 0}).sphere, 1U);
  EXPECT_NEAR(reach_beyond(press, {5e-3, 2.4e-3, -1e-3}).beyond_m, 1e-3 - 0.8e-3 - 1e-3, 1e-15);
  EXPECT_LT(reach_beyond(press, {0, 0, 0}).beyond_m, -1.0) << "between the spheres";
}

}  // namespace tact::tools::reference::tool_press_test
