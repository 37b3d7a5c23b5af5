// SPDX-License-Identifier: Apache-2.0
// The whole tool evaluated: errors as worked by hand, and every sphere felt. Times are never
// asserted.
#include "tools/chart/compare/tool_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/indent/disc_stack.h"
#include "tests/support/program.h"
#include "tests/support/test_scene.h"
#include "tools/chart/compare/chart.h"
#include "tools/chart/report/tool_report.h"

namespace tact::tools::chart::tool_check_test {

using ground_truth::ToolReference;

constexpr TimingSettings kShort{.ticks = 100, .rounds = 1, .limit_s = 0.05, .instructions = false};

/// A plate under a linear disc stack, one sphere.
model::scene::Scene make_scene() {
  model::scene::Scene scene = tests::make_plate_scene();
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

TEST(ToolErrors, MatchPenAndPaper) {
  // Peak 2 N. Errors 0.1, -0.2 and (unseen) -0.4 N.
  const std::vector<ToolSample> samples{
      {.place = 0, .depth = 0, .force_N = 1.1, .reference_N = 1.0},
      {.place = 0, .depth = 1, .force_N = 1.8, .reference_N = 2.0},
      {.place = 1, .depth = 0, .force_N = 0.6, .reference_N = 1.0}};
  const ToolErrors e = summarize_tool(samples, {false, true});
  EXPECT_NEAR(e.rms_ratio, std::sqrt((0.0025 + 0.01 + 0.04) / 3.0), 1e-12);
  EXPECT_NEAR(e.worst_ratio, 0.2, 1e-12);
  EXPECT_NEAR(e.unseen_rms_ratio, 0.2, 1e-12);
  ASSERT_EQ(e.own_worst_ratio.size(), 2U);
  EXPECT_NEAR(e.own_worst_ratio[0], -0.4, 1e-12) << "the largest in size, with its sign";
  EXPECT_NEAR(e.own_worst_ratio[1], -0.1, 1e-12);
  EXPECT_NEAR(e.place_rms_ratio[0], std::sqrt((0.0025 + 0.01) / 2.0), 1e-12);
  EXPECT_NEAR(e.own_largest_ratio, 0.4, 1e-12);
  EXPECT_NEAR(e.place_rms_ratio[1], 0.4, 1e-12) << "of its own peak";
  EXPECT_EQ(e.within_jnd_ratio, 0.0) << "10, 10 and 40 % of the own force: all can be felt";
  EXPECT_TRUE(std::isnan(summarize_tool({samples[0]}, {false}).unseen_rms_ratio));
}

TEST(ToolErrors, CountWhatAHandCannotNotice) {
  const std::vector<ToolSample> samples{{.force_N = 0.931, .reference_N = 1.0},
                                        {.force_N = 1.069, .reference_N = 1.0},
                                        {.force_N = 1.071, .reference_N = 1.0},
                                        {.force_N = 0.929, .reference_N = 1.0}};
  EXPECT_EQ(summarize_tool(samples, {true}).within_jnd_ratio, 0.5);
}

TEST(CheckTool, FindsTheErrorOfOneSphereAsWorkedByHand) {
  const model::scene::Scene scene = make_scene();
  const auto stack =
      model::indent::make_disc_stack(scene.laws.of<model::indent::DiscStackParameters>());
  ASSERT_TRUE(stack);
  const double k = stack->respond(0.001).force_N / 0.001;
  const auto row = check_tool(scene, "disc_stack", linear_truth(scene, 1.25 * k), kShort);
  ASSERT_TRUE(row) << row.error().message;
  EXPECT_EQ(row->failure, "");
  ASSERT_EQ(row->samples.size(), 4U) << "two places, two depths";
  for (const ToolSample& s : row->samples) EXPECT_NEAR(s.own_ratio(), -0.2, 1e-6);
  EXPECT_GT(row->timing.median_us, 0.0);
}

TEST(CheckTool, RendersEverySphereOfTheTool) {
  model::scene::Scene scene = make_scene();
  const auto stack =
      model::indent::make_disc_stack(scene.laws.of<model::indent::DiscStackParameters>());
  ASSERT_TRUE(stack);
  const double k = stack->respond(0.001).force_N / 0.001;
  scene.tool.spheres = {{{0, -0.03, 0}, 0.004}, {{0, 0.03, 0}, 0.004}};  // far from each other
  const auto row = check_tool(scene, "disc_stack", linear_truth(scene, k), kShort);
  ASSERT_TRUE(row) << row.error().message;
  for (const ToolSample& s : row->samples) {
    EXPECT_GT(s.own_ratio(), 0.5);
    EXPECT_LT(s.own_ratio(), 1.0 + 1e-6);
  }
}

TEST(CheckTool, IsWithoutFrictionAsTheReferenceIs) {
  model::scene::Scene scene = make_scene();
  ToolReference truth = linear_truth(scene, 20.0);
  for (auto& place : truth.places) place.direction = normalized(model::Vec3{0.3, 0.0, -1.0});
  const auto rough = check_tool(scene, "disc_stack", truth, kShort);
  scene.contact.friction_ratio = 0.0;
  const auto smooth = check_tool(scene, "disc_stack", truth, kShort);
  ASSERT_TRUE(rough && smooth);
  EXPECT_EQ(rough->samples.back().force_N, smooth->samples.back().force_N);
}

TEST(TimeTool, TimesAToolInContactOrRefuses) {
  model::scene::Scene scene = make_scene();
  scene.law = "disc_stack";
  EXPECT_TRUE(time_tool(scene, kShort).has_value());
  scene.hand_site_m.z += 0.05;
  EXPECT_FALSE(time_tool(scene, kShort).has_value());
}

TEST(CheckTool, RefusesAReferenceOfAnotherTool) {
  model::scene::Scene scene = make_scene();
  const ToolReference truth = linear_truth(scene, 20.0);
  scene.tool.spheres[0].radius_m = 0.005;
  const auto row = check_tool(scene, "disc_stack", truth, kShort);
  ASSERT_FALSE(row);
  EXPECT_NE(row.error().message.find("spheres"), std::string::npos);
}

TEST(Chart, JudgesEverySizeByTheWholeToolWhereItIsKnown) {
  const model::scene::Scene scene = make_scene();
  const auto stack =
      model::indent::make_disc_stack(scene.laws.of<model::indent::DiscStackParameters>());
  ASSERT_TRUE(stack);
  const double k = stack->respond(0.001).force_N / 0.001;
  ground_truth::ReferenceData one_sphere;
  one_sphere.body.youngs_modulus_Pa = 5000.0;
  one_sphere.body.poisson_ratio = 0.45;
  one_sphere.tool_radius_m = 0.004;
  one_sphere.ring_pitch_m = 0.004;
  one_sphere.sites = {{.vertex = 220, .point_m = {0, 0, 0}, .direction = {0, 0, -1}, .cases = {}}};
  one_sphere.sites[0].cases = {
      {.depth_m = 0.001, .force_N = 1.25 * k * 0.001, .profile_m = {0.001, 0.0}}};
  ToolReference whole_tool = linear_truth(scene, 0.5 * k);
  ChartOptions options{
      .request = {.laws = {}, .quick = true}, .timing = kShort, .tool_reference = &whole_tool};
  const auto rows = measure_chart(scene, one_sphere, options);
  ASSERT_TRUE(rows) << rows.error().message;
  std::size_t linear = 0;
  for (const ChartRow& row : *rows) {
    if (row.variant.sizes.disc_form != "linear") continue;
    ++linear;
    ASSERT_EQ(row.failure, "");
    ASSERT_TRUE(row.tool);
    EXPECT_NEAR(row.tool->own_largest_ratio, 1.0, 1e-6) << "twice the force of the whole tool";
    EXPECT_NEAR(row.errors.force_worst_ratio, 0.2, 1e-9) << "one sphere is evaluated by its own";
    EXPECT_GT(row.timing.median_us, 0.0);
  }
  EXPECT_GT(linear, 0U);
  whole_tool.sphere[0].radius_m = 0.005;
  EXPECT_FALSE(measure_chart(scene, one_sphere, options)) << "another tool";
}

TEST(ToolReport, HasARowForEachLawPlaceAndDepthAndASummary) {
  const model::scene::Scene scene = make_scene();
  const ToolReference truth = linear_truth(scene, 20.0);
  const auto row = check_tool(scene, "disc_stack", truth, kShort);
  ASSERT_TRUE(row) << row.error().message;
  const auto j = nlohmann::json::parse(tool_json({*row}, truth, "tact-lab chart x", {}));
  EXPECT_EQ(j.at("format"), "tact-tool-chart");
  EXPECT_EQ(j.at("rows").size(), 4U);
  EXPECT_EQ(j.at("rows")[3].at("place"), "220");
  const auto& law = j.at("laws")[0];
  EXPECT_EQ(law.at("law"), "disc_stack");
  EXPECT_NEAR(law.at("own_worst_ratio_at_mm").at("2").get<double>(), row->errors.own_worst_ratio[1],
              1e-9);
  EXPECT_TRUE(law.at("place_rms_ratio").contains("hand's"));
  const std::string text = tool_text({*row}, truth);
  for (const char* word : {"disc_stack", "hand's", "220", "1 mm", "2 mm"})
    EXPECT_NE(text.find(word), std::string::npos) << word;
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
