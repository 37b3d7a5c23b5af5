// SPDX-License-Identifier: Apache-2.0
// What every law answers at the places of a reference. Times are never asserted.
#include "tools/chart/compare/chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "model/indent/disc_stack.h"
#include "model/indent/hex_sheet.h"
#include "model/indent/hunt_crossley.h"
#include "model/springs/spring_patch.h"
#include "tests/support/test_scene.h"

namespace tact::tools::chart::chart_test {

constexpr TimingSettings kShort{.ticks = 100, .rounds = 1, .limit_s = 0.05, .instructions = false};
constexpr std::uint32_t kMiddle = 220;  // vertex of the plate, 20 x 20 cells

/// A plate with every law that needs no file.
model::scene::Scene make_scene() {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.described = {"rhombus", "disc_stack", "hex_sheet", "spring_patch", "hunt_crossley"};
  scene.laws.of<model::indent::HuntCrossleyParameters>() = {.force_N = 0.3,
                                                            .working_depth_m = 0.01};
  scene.laws.of<model::indent::DiscStackParameters>() = tests::make_linear_discs();
  scene.laws.of<model::indent::HexSheetParameters>() = {.ring_pitch_m = 0.004,
                                                        .contact_stiffness_N_per_m = 5.0,
                                                        .body_stiffness_N_per_m = 1.0,
                                                        .surface_stiffness_N_per_m = 20.0,
                                                        .tension_N = 0.02,
                                                        .rings = 5,
                                                        .working_depth_m = 0.01};
  auto& patch = scene.laws.of<model::springs::SpringPatchParameters>();
  patch.tissue = {.surface_stiffness_N_per_m = 20.0,
                  .body_stiffness_N_per_m = 5.0,
                  .damping_time_s = 0.005,
                  .body_damping_time_s = 0.01};
  patch.coupling_stiffness_N_per_m = 100.0;
  patch.node_mass_kg = 0.001;
  patch.working_depth_m = 0.01;
  patch.method.integrator = model::springs::Integrator::kImplicitEuler;
  scene.reference_sites = {{.vertex = kMiddle, .held_out = false}};
  scene.hand_inward = {0, 0, -1};
  scene.contact.tear_force_N = 0.3;  // reached by every law, else the scene is refused
  return scene;
}

/// Truth: a spring of this stiffness in the middle of the plate, and an indentation that ends at 4
/// mm.
ground_truth::ReferenceData linear_truth(double stiffness_N_per_m) {
  ground_truth::ReferenceData data;
  data.body.mesh = "plate";
  data.tool_radius_m = 0.004;
  data.ring_pitch_m = 0.004;
  ground_truth::SolvedSite site{
      .vertex = kMiddle, .point_m = {0, 0, 0}, .direction = {0, 0, -1}, .cases = {}};
  for (const double depth_m : {0.001, 0.002})
    site.cases.push_back(
        {.depth_m = depth_m, .force_N = stiffness_N_per_m * depth_m, .profile_m = {depth_m, 0.0}});
  data.sites.push_back(site);
  return data;
}

ChartOptions quick() { return {.request = {.laws = {}, .quick = true}, .timing = kShort}; }

TEST(Chart, PressesEveryLawAsWorkedByHand) {
  const model::scene::Scene scene = make_scene();
  // The linear disc stack is F = k d: against 1.25 k it is off by 20 % everywhere.
  const auto stack =
      model::indent::make_disc_stack(scene.laws.of<model::indent::DiscStackParameters>());
  ASSERT_TRUE(stack);
  const double k = stack->respond(0.001).force_N / 0.001;
  const auto rows = measure_chart(scene, linear_truth(1.25 * k), quick());
  ASSERT_TRUE(rows) << rows.error().message;
  std::vector<std::string> families;
  for (const Measured& row : *rows) {
    EXPECT_EQ(row.failure, "") << row.variant.sizes.law;
    EXPECT_GT(row.memory_bytes, 0U);
    EXPECT_GT(row.timing.ticks, 0U);
    EXPECT_EQ(row.answers.samples.size(), 2U);
    families.push_back(row.variant.sizes.law);
    if (row.variant.sizes.disc_form != "linear") continue;
    EXPECT_EQ(row.answers.settle_ticks, 1);
    for (const Sample& s : row.answers.samples) {
      EXPECT_NEAR(s.force_N / s.reference_N, 0.8, 1e-9);
      EXPECT_EQ(s.ring_m.size(), s.reference_ring_m.size());
      EXPECT_NEAR(s.ring_m[0], s.depth_m, 1e-9) << "the tip's middle";
    }
  }
  for (const char* law : {"rhombus", "disc_stack", "hex_sheet", "spring_patch", "hunt_crossley"})
    EXPECT_NE(std::ranges::find(families, law), families.end()) << law;
}

TEST(Chart, ALinearReferenceJudgesTheComplianceLawAtSmallStrain) {
  const auto liver = model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", {});
  const auto truth =
      ground_truth::read_reference(TACT_SOURCE_DIR "/tests/data/reference/liver.json");
  ASSERT_TRUE(liver && truth);
  EXPECT_TRUE(liver->compliance.large_strain) << "as it is felt";
  ChartOptions options = quick();
  options.request.laws = {"compliance"};
  const auto rows = measure_chart(*liver, *truth, options);
  ASSERT_TRUE(rows) << rows.error().message;
  const std::vector<Sample>& samples = rows->back().answers.samples;
  double peak_N = 0.0, worst_N = 0.0;
  for (const Sample& s : samples) {
    peak_N = std::max(peak_N, std::abs(s.reference_N));
    worst_N = std::max(worst_N, std::abs(s.force_N - s.reference_N));
  }
  EXPECT_LT(worst_N, 0.02 * peak_N);
}

TEST(Chart, GivesItsScriptNumbersWithoutLoss) {
  Measured row;
  row.variant.sizes = {.law = "disc_stack", .size = 7, .disc_form = "linear"};
  row.answers.samples = {{.site = 1,
                          .depth_m = -0.002,
                          .force_N = 0.1,
                          .reference_N = 0.3,
                          .ring_m = {0.1 + 0.2, std::nan("")},
                          .reference_ring_m = {0.0, 0.0}}};
  const auto back = nlohmann::json::parse(to_json(row).dump());
  EXPECT_EQ(back.at("samples")[0].at("ring_m")[0], 0.1 + 0.2);
  EXPECT_TRUE(back.at("samples")[0].at("ring_m")[1].is_null()) << "not known";
  EXPECT_TRUE(back.at("tool_N").is_null()) << "no reference of the whole tool";
  EXPECT_EQ(back.at("size_count"), 7);
}

TEST(Chart, TakesPeersOfThisReferenceAlone) {
  const std::string peers = TACT_SOURCE_DIR "/tools/results/peers.json";
  const auto rows = read_chart(peers);
  ASSERT_TRUE(rows) << rows.error().message;
  const std::string truth = rows->at(0).at("reference_hash");
  const auto found = peers_of(peers, truth);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->size(), rows->size());
  EXPECT_TRUE(peers_of("", truth)->empty());
  const auto wrong = peers_of(peers, "another truth");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message.find(peers + ": row 0 is no peer"), 0U) << wrong.error().message;
}

TEST(Chart, RefusesAFileThatIsNoChart) {
  const std::string path = testing::TempDir() + "tact_no_chart.json";
  for (const char* text : {"{", "[]", "{}", R"({"format": "tact-chart", "version": 3, "rows": []})",
                           R"({"format": "tact-chart", "version": 4, "rows": 5})"}) {
    std::ofstream(path) << text;
    const auto rows = read_chart(path);
    ASSERT_FALSE(rows) << text;
    EXPECT_NE(rows.error().message.find("tact-lab chart SCENE"), std::string::npos) << text;
  }
  std::ofstream(path) << R"({"format": "tact-chart", "version": 4, "rows": [5]})";
  EXPECT_TRUE(read_chart(path));
  EXPECT_FALSE(peers_of(path, "truth"));
}

TEST(Chart, RefusesAReferenceOfAnotherMeshOrTip) {
  const model::scene::Scene scene = make_scene();
  ground_truth::ReferenceData moved = linear_truth(30.0);
  moved.sites[0].point_m.x = 0.001;
  ground_truth::ReferenceData blunt = linear_truth(30.0);
  blunt.tool_radius_m = 0.005;
  for (const auto& wrong : {moved, blunt}) {
    const auto rows = measure_chart(scene, wrong, quick());
    ASSERT_FALSE(rows);
    EXPECT_NE(rows.error().message.find("solve it again: tact-lab reference"), std::string::npos);
  }
}

}  // namespace tact::tools::chart::chart_test
