// SPDX-License-Identifier: Apache-2.0
// The whole tool presses: forces as worked by hand, of every sphere. Times are never asserted.
#include "tools/chart/compare/tool_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/indent/disc_stack.h"
#include "tests/support/program.h"
#include "tests/support/test_scene.h"
#include "tools/chart/compare/chart.h"

namespace tact::tools::chart::tool_check_test {

using ground_truth::ToolReference;

constexpr TimingSettings kShort{.ticks = 100, .rounds = 1, .limit_s = 0.05, .instructions = false};

/// A plate under a linear disc stack, one sphere.
model::scene::Scene make_scene() {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.law = "disc_stack";
  scene.described = {"disc_stack"};
  scene.laws.of<model::indent::DiscStackParameters>() = tests::make_linear_discs();
  scene.hand_inward = {0, 0, -1};
  scene.elastic = model::scene::ElasticSettings{.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45};
  return scene;
}

/// Truth: a spring of this stiffness, straight down.
ToolReference linear_truth(const model::scene::Scene& scene, double stiffness_N_per_m) {
  ToolReference data;
  data.body.youngs_modulus_Pa = 5000.0;
  data.body.poisson_ratio = 0.45;
  data.sphere = scene.tool.spheres;
  ground_truth::ToolPoint place;
  place.direction = {0, 0, -1};
  for (const double depth_m : {0.001, 0.002})
    place.cases.push_back({.depth_m = depth_m,
                           .force_N = stiffness_N_per_m * depth_m,
                           .sphere_N = std::vector<double>(scene.tool.spheres.size()),
                           .force_error_ratio = 0.01});
  data.places = {place, place};
  data.places[1].vertex = 220;  // of the plate's middle
  return data;
}

/// k of its linear disc stack.
double stiffness_of(const model::scene::Scene& scene) {
  const auto stack =
      model::indent::make_disc_stack(scene.laws.of<model::indent::DiscStackParameters>());
  return stack ? stack->respond(0.001).force_N / 0.001 : std::nan("");
}

TEST(PressTool, FindsTheForceOfOneSphereAsWorkedByHand) {
  const model::scene::Scene scene = make_scene();
  const double k = stiffness_of(scene);
  const auto force_N = press_tool(scene, linear_truth(scene, k));
  ASSERT_TRUE(force_N) << force_N.error().message;
  ASSERT_EQ(force_N->size(), 4U) << "two places, two depths";
  for (const std::size_t i : {0, 1, 2, 3})
    EXPECT_NEAR((*force_N)[i], k * static_cast<double>(i % 2 + 1) * 1e-3, 1e-9);
}

TEST(PressTool, RendersEverySphereOfTheTool) {
  model::scene::Scene scene = make_scene();
  const double k = stiffness_of(scene);
  scene.tool.spheres = {{{0, -0.03, 0}, 0.004}, {{0, 0.03, 0}, 0.004}};  // far from each other
  const auto force_N = press_tool(scene, linear_truth(scene, k));
  ASSERT_TRUE(force_N) << force_N.error().message;
  for (const std::size_t i : {0, 1, 2, 3}) {
    EXPECT_GT((*force_N)[i], 1.5 * k * static_cast<double>(i % 2 + 1) * 1e-3);
    EXPECT_LT((*force_N)[i], 2.0 * k * static_cast<double>(i % 2 + 1) * 1e-3 + 1e-9);
  }
}

TEST(PressTool, IsWithoutFrictionAsTheReferenceIs) {
  model::scene::Scene scene = make_scene();
  ToolReference truth = linear_truth(scene, 20.0);
  for (auto& place : truth.places) place.direction = normalized(model::Vec3{0.3, 0.0, -1.0});
  const auto rough = press_tool(scene, truth);
  scene.contact.friction_ratio = 0.0;
  const auto smooth = press_tool(scene, truth);
  ASSERT_TRUE(rough && smooth);
  EXPECT_EQ(*rough, *smooth);
}

TEST(TimeTool, TimesAToolInContactOrRefuses) {
  model::scene::Scene scene = make_scene();
  scene.law = "disc_stack";
  EXPECT_TRUE(time_tool(scene, kShort).has_value());
  scene.hand_site_m.z += 0.05;
  EXPECT_FALSE(time_tool(scene, kShort).has_value());
}

TEST(PressTool, RefusesAReferenceOfAnotherTool) {
  model::scene::Scene scene = make_scene();
  ChartOptions options{
      .request = {}, .timing = kShort, .tool_reference = linear_truth(scene, 20.0)};
  scene.tool.spheres[0].radius_m = 0.005;
  const auto rows = measure_tool(scene, options);
  ASSERT_FALSE(rows);
  EXPECT_NE(rows.error().message.find("spheres"), std::string::npos);
  EXPECT_FALSE(press_tool(scene, *options.tool_reference));
}

TEST(MeasureTool, HasEveryWantedLawWithItsTime) {
  const model::scene::Scene scene = make_scene();
  ChartOptions options{
      .request = {}, .timing = kShort, .tool_reference = linear_truth(scene, 20.0)};
  const auto rows = measure_tool(scene, options);
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), 1U);
  EXPECT_EQ(rows->front().failure, "");
  EXPECT_EQ(rows->front().tool->size(), 4U);
  EXPECT_GT(rows->front().timing.median_us, 0.0);
  options.request.laws = {"rhombus"};
  EXPECT_FALSE(measure_tool(scene, options)) << "the scene does not describe it";
}

TEST(Chart, PressesEverySizeWithTheWholeToolWhereItIsKnown) {
  const model::scene::Scene scene = make_scene();
  const double k = stiffness_of(scene);
  ground_truth::ReferenceData one_sphere;
  one_sphere.body.youngs_modulus_Pa = 5000.0;
  one_sphere.body.poisson_ratio = 0.45;
  one_sphere.tool_radius_m = 0.004;
  one_sphere.ring_pitch_m = 0.004;
  one_sphere.sites = {{.vertex = 220, .point_m = {0, 0, 0}, .direction = {0, 0, -1}, .cases = {}}};
  one_sphere.sites[0].cases = {
      {.depth_m = 0.001, .force_N = 1.25 * k * 0.001, .profile_m = {0.001, 0.0}}};
  ChartOptions options{.request = {.laws = {}, .quick = true},
                       .timing = kShort,
                       .tool_reference = linear_truth(scene, 0.5 * k)};
  const auto rows = measure_chart(scene, one_sphere, options);
  ASSERT_TRUE(rows) << rows.error().message;
  std::size_t linear = 0;
  for (const Measured& row : *rows) {
    if (row.variant.sizes.disc_form != "linear") continue;
    ++linear;
    ASSERT_EQ(row.failure, "");
    ASSERT_TRUE(row.tool);
    EXPECT_NEAR(row.tool->front(), k * 0.001, 1e-9);
    EXPECT_NEAR(row.answers.samples.front().force_N, k * 0.001, 1e-9);
    EXPECT_GT(row.timing.median_us, 0.0);
  }
  EXPECT_GT(linear, 0U);
  options.tool_reference->sphere[0].radius_m = 0.005;
  EXPECT_FALSE(measure_chart(scene, one_sphere, options)) << "another tool";
}

TEST(Chart, NamesThePlacesOfTheWholeTool) {
  const model::scene::Scene scene = make_scene();
  const auto places = to_json(linear_truth(scene, 20.0));
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0].at("place"), "hand's");
  EXPECT_EQ(places[0].at("unseen"), false);
  EXPECT_EQ(places[1].at("place"), "220");
  EXPECT_EQ(places[1].at("unseen"), true);
  EXPECT_EQ(places[1].at("cases")[1].at("reference_N"), 20.0 * 0.002);
}

TEST(ChartProgram, SaysWhichReferenceItNeeds) {
  const std::string liver = TACT_SOURCE_DIR "/model/scenes/liver.toml --out " + testing::TempDir();
  const auto none = tests::run_program("tact-lab chart", liver);
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.output.find("--tool-reference"), std::string::npos) << none.output;
  const auto both = tests::run_program("tact-lab chart",
                                       liver + " --reference a --tool-reference b --accuracy c");
  EXPECT_EQ(both.status, 2) << "a figure is of the scene's own laws";
}

}  // namespace tact::tools::chart::tool_check_test
