// SPDX-License-Identifier: Apache-2.0
#include "tools/condense/condense_organ.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "model/scene/compliance_file.h"
#include "model/scene/press.h"
#include "model/scene/tissue_map.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"
#include "tests/support/test_scene.h"
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

/// A scene of that ball with a lump of ten times its modulus, 10 mm below its top.
model::scene::Scene ball_scene(double radius_m) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.organ_mesh = tests::make_ball(0.03, 3);
  scene.law = "compliance";
  scene.compliance = {.map_path = {}, .working_depth_m = 0.008};
  scene.contact.tear_force_N = 0.1;
  scene.contact.sliding_stiffness_N_per_m = 0.0;
  scene.elastic = {.youngs_modulus_Pa = 4000.0,
                   .poisson_ratio = 0.45,
                   .fixed_min_m = {-1.0, -1.0, -1.0},
                   .fixed_max_m = {1.0, 1.0, -0.015}};
  if (radius_m > 0.0)
    scene.elastic->inclusions = {
        {.center_m = {0.0, 0.0, 0.02}, .radius_m = radius_m, .youngs_modulus_Pa = 40000.0}};
  return scene;
}

struct Presses {
  double over_N = 0.0, beside_N = 0.0;
};

/// Forces of presses 5 mm deep, where the ball looks up and where it looks aside.
Presses pressed(model::scene::Scene scene) {
  const tests::TempDirectory folder;
  scene.compliance.map_path = folder.path() + "/ball.compliance";
  auto input = condense_input(scene);
  input->settings.mesh_size_m = 0.005;
  CondenseFacts facts;
  const auto map = condense_organ(*input, facts);
  EXPECT_TRUE(map) << map.error().message;
  EXPECT_TRUE(model::scene::write_compliance_map(*map, scene.compliance.map_path));
  const auto presser = model::scene::Presser::make(scene, {.step_m = 1e-4, .depth_m = 0.005});
  EXPECT_TRUE(presser) << presser.error().message;
  const auto press_N = [&](const model::Vec3& way) {
    const auto& normal = scene.organ_mesh.vertex_normal;
    const auto vertex =
        std::ranges::max_element(normal, {}, [&](const model::Vec3& n) { return dot(n, way); });
    const auto place = static_cast<std::uint32_t>(vertex - normal.begin());
    return (*presser)->press({place, model::scene::PressWay::kSquare}).force_N;
  };
  return {.over_N = press_N({0.0, 0.0, 1.0}), .beside_N = press_N({1.0, 0.0, 0.1})};
}

TEST(CondenseOrgan, ALumpIsFeltOverItAndNotBesideIt) {
  const Presses plain = pressed(ball_scene(0.0)), lump = pressed(ball_scene(0.008));
  EXPECT_GT(lump.over_N / plain.over_N, 1.07) << "more than a hand notices";
  EXPECT_NEAR(lump.beside_N / plain.beside_N, 1.0, 0.01);
}

TEST(CondenseOrgan, ALumpBelongsToItsMapAndLiesInTheOrgan) {
  const tests::TempDirectory folder;
  model::scene::Scene scene = ball_scene(0.007);
  scene.compliance.map_path = folder.path() + "/ball.compliance";
  CondenseFacts facts;
  const auto map = condense_organ(*condense_input(scene), facts);
  ASSERT_TRUE(map) << map.error().message;
  ASSERT_TRUE(model::scene::write_compliance_map(*map, scene.compliance.map_path));
  EXPECT_TRUE(read_scene_map(scene));
  scene.elastic->youngs_modulus_Pa *= 2.0;
  EXPECT_FALSE(read_scene_map(scene)) << "the ratio counts";
  scene.elastic->inclusions[0].youngs_modulus_Pa *= 2.0;
  EXPECT_TRUE(read_scene_map(scene));
  scene.elastic->inclusions.clear();
  const auto other = read_scene_map(scene);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("[[elastic.inclusion]]"), std::string::npos);

  for (const auto& [center_m, radius_m, words] :
       {std::tuple<model::Vec3, double, const char*>{
            {0.0, 0.0, 0.02}, 0.011, "1 of 1 has its centre 10 mm below the surface"},
        {{0.0, 0.0, 0.04}, 0.003, "1 of 1 has its centre 10 mm outside the surface"}}) {
    scene.elastic->inclusions = {{center_m, radius_m, 40000.0}};
    const auto refused = condense_organ(*condense_input(scene), facts);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find(words), std::string::npos) << refused.error().message;
  }
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
