// SPDX-License-Identifier: Apache-2.0
#include "tools/condense/condense_organ.h"

#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tools/program/run_program.h"

namespace tact::tools::condense::condense_organ_test {

// A ball of 30 mm, held below z = -15 mm.
CondenseInput ball() {
  CondenseInput input{.surface = tests::make_ball(0.03, 2)};
  input.settings.organ = {.poisson_ratio = 0.45,
                          .fixed_min_m = {-1.0, -1.0, -1.0},
                          .fixed_max_m = {1.0, 1.0, -0.015},
                          .ring_pitch_m = 0.005,
                          .rings = 6,
                          .run_jobs = model::fem::one_after_the_other};
  return input;
}

TEST(CondenseOrgan, FillsASurfaceAndFindsItSoftestFarFromWhereItIsHeld) {
  const CondenseInput input = ball();
  CondenseFacts facts;
  const auto map = condense_organ(input, facts);
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_GT(facts.elements, 100u);
  EXPECT_NEAR(facts.mesh_size_m, 1.5 * median_edge_m(input.surface.view()), 1e-12);
  EXPECT_NEAR(map->patch_radius_m, 1.6 * facts.mesh_size_m, 1e-12);
  ASSERT_EQ(map->vertices(), input.surface.vertex_m.size());
  std::size_t top = 0, bottom = 0;
  for (std::size_t v = 0; v < map->vertices(); ++v) {
    if (input.surface.vertex_m[v].z > input.surface.vertex_m[top].z) top = v;
    if (input.surface.vertex_m[v].z < input.surface.vertex_m[bottom].z) bottom = v;
  }
  EXPECT_GT(map->regular_times_E_per_m[top], map->regular_times_E_per_m[bottom] + 5.0F);
}

TEST(CondenseOrgan, RefusesASurfaceWithoutAnInside) {
  CondenseInput input = ball();
  input.surface = tests::make_plate(0.1, 4);
  CondenseFacts facts;
  const auto map = condense_organ(input, facts);
  ASSERT_FALSE(map);
  EXPECT_NE(map.error().message.find("open edges"), std::string::npos);
}

TEST(CondenseOrgan, StopsWhenAsked) {
  CondenseInput input = ball();
  input.settings.organ.run_jobs = [](auto...) { return program::interruption(); };
  CondenseFacts facts;
  const auto stopped = condense_organ(input, facts);
  ASSERT_FALSE(stopped);
  EXPECT_TRUE(program::was_interrupted(stopped.error())) << stopped.error().message;
}

TEST(CondenseOrgan, TakesTheOrganOfTheSceneInItsOwnFrame) {
  model::scene::Scene scene;
  scene.path = "some.toml";
  const auto without = condense_input(scene);
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().message.find("[elastic]"), std::string::npos);
  scene.organ_mesh = tests::make_ball(0.03, 1);
  scene.organ.position_m = {0.0, 0.0, -0.03};
  for (model::Vec3& p : scene.organ_mesh.vertex_m) p += scene.organ.position_m;
  scene.elastic = model::scene::ElasticSettings{.youngs_modulus_Pa = 5000.0,
                                                .poisson_ratio = 0.3,
                                                .fixed_min_m = {-1.0, -1.0, -1.0},
                                                .fixed_max_m = {1.0, -0.032, 1.0}};
  const auto input = condense_input(scene);
  ASSERT_TRUE(input);
  EXPECT_NEAR(norm(input->surface.vertex_m[0]), 0.03, 1e-12);
  EXPECT_EQ(input->settings.organ.poisson_ratio, 0.3);
  EXPECT_EQ(input->settings.organ.fixed_max_m, scene.elastic->fixed_max_m);
}

}  // namespace tact::tools::condense::condense_organ_test
