// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_data.h"

#include <gtest/gtest.h>

#include "model/units.h"
#include "tests/support/test_scene.h"

namespace tact::tools::fit::fit_data_test {

using model::operator""_mm;

ground_truth::ReferenceData make_reference(const model::scene::Scene& scene) {
  ground_truth::ReferenceData data{.body = {.mesh = "plate.obj",
                                            .mesh_hash = "",
                                            .solver = "",
                                            .youngs_modulus_Pa = 5000.0,
                                            .poisson_ratio = 0.45},
                                   .tool_radius_m = 4_mm,
                                   .ring_pitch_m = 2_mm,
                                   .sites = {}};
  for (const std::uint32_t vertex : {30U, 200U}) {
    ground_truth::SolvedSite site{
        .vertex = vertex,
        .point_m = scene.organ_mesh.vertex_m[vertex] - scene.organ.position_m,
        .direction = {0, 0, -1},
        .cases = {}};
    site.cases = {{.depth_m = 5_mm, .force_N = 0.2, .profile_m = {5_mm, 3_mm}},
                  {.depth_m = -5_mm, .force_N = -0.3, .profile_m = {-5_mm}},
                  {.depth_m = 9_mm, .large_strain = true, .force_N = 0.5, .profile_m = {9_mm}}};
    data.sites.push_back(site);
  }
  return data;
}

TEST(FitData, KeepsTheLinearCasesAndTheSitesThatTheSceneHoldsOut) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.reference_sites = {{.vertex = 30}, {.vertex = 200, .held_out = true}};
  const auto data = fit_data_of(make_reference(scene), scene, {}, false);
  ASSERT_TRUE(data) << data.error().message;
  ASSERT_EQ(data->sites.size(), 2U);
  EXPECT_FALSE(data->sites[0].held_out);
  EXPECT_TRUE(data->sites[1].held_out);
  EXPECT_EQ(data->sites[0].samples.size(), 2U);
  EXPECT_EQ(data->peak_N(), 0.3);
  EXPECT_EQ(data->deepest_m(), 5_mm);
  EXPECT_EQ(data->ring_radius_m, (std::vector<double>{0.0, 2_mm}));
  EXPECT_TRUE(std::isnan(data->sites[0].samples[1].ring_m[1]));  // not known there
  EXPECT_TRUE(data->has_places());
  EXPECT_EQ(data->sites[0].at->normal, (model::Vec3{0, 0, 1}));
  const auto large = fit_data_of(make_reference(scene), scene, {}, true);
  ASSERT_TRUE(large);
  EXPECT_EQ(large->sites[0].samples.size(), 1U);
  EXPECT_EQ(large->deepest_m(), 9_mm);
}

TEST(FitData, RefusesAnotherOrganAndNothingToFit) {
  model::scene::Scene scene = tests::make_plate_scene();
  ground_truth::ReferenceData reference = make_reference(scene);
  reference.sites[1].vertex = 1000000;
  const auto stranger = fit_data_of(reference, scene, {}, false);
  ASSERT_FALSE(stranger);
  EXPECT_NE(stranger.error().message.find("vertex 1000000"), std::string::npos);
  EXPECT_FALSE(fit_data_of(make_reference(scene), scene, {"31"}, false));  // no such site
  scene.reference_sites = {{.vertex = 30, .held_out = true}};
  const auto rest = fit_data_of(make_reference(scene), scene, {"200"}, false);
  ASSERT_FALSE(rest);
  EXPECT_NE(rest.error().message.find("leave one to fit"), std::string::npos);
  scene.reference_sites.push_back({.vertex = 200, .held_out = true});
  EXPECT_FALSE(fit_data_of(make_reference(scene), scene, {}, false));
}

TEST(FitData, AVertexIsAPlaceWithAllItsWeight) {
  const model::mesh::SurfaceMesh plate = tests::make_plate(0.1, 4);
  for (std::size_t v = 0; v < plate.vertex_m.size(); ++v) {
    const auto at = surface_point_at_vertex(plate, v);
    ASSERT_TRUE(at);
    model::Vec3 point{};
    for (std::size_t i = 0; i < 3; ++i)
      point += at->surface_point.weight[i] *
               plate.vertex_m[plate.triangle[at->surface_point.triangle][i]];
    EXPECT_EQ(point, plate.vertex_m[v]);
  }
  EXPECT_FALSE(surface_point_at_vertex(plate, plate.vertex_m.size()));
}

}  // namespace tact::tools::fit::fit_data_test
