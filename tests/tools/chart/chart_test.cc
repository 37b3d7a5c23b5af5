// SPDX-License-Identifier: Apache-2.0
// The chart: errors as worked by hand, a front without a dominated point. Times are never
// asserted.
#include "tools/chart/compare/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <sstream>

#include "model/indent/disc_stack.h"
#include "model/indent/hex_sheet.h"
#include "model/indent/hunt_crossley.h"
#include "model/springs/spring_patch.h"
#include "tests/support/test_scene.h"
#include "tools/chart/report/report.h"

namespace tact::tools::chart::chart_test {

constexpr TimingSettings kShort{.ticks = 100, .rounds = 1, .limit_s = 0.05, .instructions = false};
constexpr std::uint32_t kMiddle = 220;  // vertex of the plate, 20 x 20 cells

std::string scratch_folder(const std::string& name) {
  const auto path = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path.string();
}

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

report::Table chart_of(const model::scene::Scene& scene,
                       const ground_truth::ReferenceData& reference, const ChartOptions& options) {
  const auto rows = measure_chart(scene, reference, options);
  EXPECT_TRUE(rows) << (rows ? "" : rows.error().message);
  report::Table table("chart");
  for (const ChartRow& row : *rows) table.add(table_row(row, {"scene", "truth", "r1", "here"}));
  return table;
}

ChartOptions quick() { return {.request = {.laws = {}, .quick = true}, .timing = kShort}; }

TEST(Errors, MatchPenAndPaper) {
  // Peak 2 N. Errors 0.1, -0.2 and (pull) 0.4 N: 5, 10 and 20 % of it.
  const std::vector<Sample> samples{{.site = 0,
                                     .depth_m = 0.001,
                                     .force_N = 1.1,
                                     .reference_N = 1.0,
                                     .ring_m = {},
                                     .reference_ring_m = {}},
                                    {.site = 0,
                                     .depth_m = 0.002,
                                     .force_N = 1.8,
                                     .reference_N = 2.0,
                                     .ring_m = {0.002, 0.001},
                                     .reference_ring_m = {0.002, 0.0}},
                                    {.site = 1,
                                     .held_out = true,
                                     .depth_m = -0.002,
                                     .force_N = -0.6,
                                     .reference_N = -1.0,
                                     .ring_m = {},
                                     .reference_ring_m = {}}};
  const ErrorSummary e = summarize(samples);
  EXPECT_NEAR(e.force_rms_ratio, std::sqrt((0.0025 + 0.01 + 0.04) / 3.0), 1e-12);
  EXPECT_NEAR(e.press_rms_ratio, std::sqrt((0.0025 + 0.01) / 2.0), 1e-12);
  EXPECT_NEAR(e.pull_rms_ratio, 0.2, 1e-12);
  EXPECT_NEAR(e.held_out_rms_ratio, 0.2, 1e-12);
  EXPECT_NEAR(e.worst_site_rms_ratio, 0.4, 1e-12);  // 0.4 N of that site's own 1 N
  EXPECT_NEAR(e.force_worst_ratio, 0.2, 1e-12);
  EXPECT_NEAR(e.shape_rms_ratio, std::sqrt(0.5) * 0.5,
              1e-12);                  // one of two rings off by half the depth
  EXPECT_EQ(e.within_jnd_ratio, 0.0);  // 10, 10 and 40 %: all can be noticed
  EXPECT_NEAR(e.own_worst_ratio[0], 0.1, 1e-12) << "at 1 mm, with its sign";
  EXPECT_NEAR(e.own_worst_ratio[1], -0.1, 1e-12) << "at 2 mm; the pull does not count";
  EXPECT_TRUE(std::isnan(e.own_worst_ratio[2])) << "no press by 5 mm";
  EXPECT_NEAR(e.own_largest_ratio, 0.1, 1e-12);
}

TEST(Errors, CountWhatAHandCannotNotice) {
  const std::vector<Sample> samples{{.depth_m = 0.001,
                                     .force_N = 1.069,
                                     .reference_N = 1.0,
                                     .ring_m = {},
                                     .reference_ring_m = {}},
                                    {.depth_m = 0.002,
                                     .force_N = 1.071,
                                     .reference_N = 1.0,
                                     .ring_m = {},
                                     .reference_ring_m = {}}};
  EXPECT_EQ(summarize(samples).within_jnd_ratio, 0.5);
}

TEST(Front, HasNoDominatedPointAndMissesNone) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> number(1, 12);  // few values: many ties
  for (int round = 0; round < 200; ++round) {
    std::vector<SpeedAndError> points(20);
    for (auto& p : points) p = {double(number(random)), double(number(random))};
    points[3].error_ratio = std::nan("");
    const auto front = front_of(points);
    const auto is_beaten = [&](const SpeedAndError& p) {
      return std::any_of(points.begin(), points.end(), [&](const auto& other) {
        return other.tick_us <= p.tick_us && other.error_ratio <= p.error_ratio &&
               (other.tick_us < p.tick_us || other.error_ratio < p.error_ratio);
      });
    };
    for (const std::size_t i : front) EXPECT_FALSE(is_beaten(points[i]));
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::find(front.begin(), front.end(), i) != front.end() || i == 3) continue;
      const bool has_twin = std::any_of(front.begin(), front.end(), [&](std::size_t f) {
        return points[f].tick_us == points[i].tick_us &&
               points[f].error_ratio == points[i].error_ratio;
      });
      EXPECT_TRUE(is_beaten(points[i]) || has_twin);
    }
  }
}

TEST(Chart, GivesEveryLawARowWithTheErrorWorkedByHand) {
  const model::scene::Scene scene = make_scene();
  // The linear disc stack is F = k d. Against 1.25 k: errors 0.25 k d, peak 2.5 k mm, so
  // 0.1 sqrt((1 + 4) / 2) = 0.158114.
  const auto stack =
      model::indent::make_disc_stack(scene.laws.of<model::indent::DiscStackParameters>());
  ASSERT_TRUE(stack);
  const double k = stack->respond(0.001).force_N / 0.001;
  const report::Table table = chart_of(scene, linear_truth(1.25 * k), quick());
  std::vector<std::string> families;
  for (const report::Row& row : table.rows()) {
    EXPECT_EQ(word(row, "failure"), "-") << word(row, "family");
    EXPECT_GT(number(row, "memory_bytes"), 0.0);
    EXPECT_GT(number(row, "ticks"), 0.0);
    families.push_back(word(row, "family"));
    if (word(row, "form") == "linear") {
      EXPECT_NEAR(number(row, "force_rms_ratio"), 0.1 * std::sqrt(2.5), 1e-9);
      EXPECT_NEAR(number(row, "force_worst_ratio"), 0.2, 1e-9);
      EXPECT_NEAR(number(row, "own_worst_1mm_ratio"), -0.2, 1e-9);
      EXPECT_NEAR(number(row, "own_worst_ratio"), 0.2, 1e-9);
      EXPECT_TRUE(std::isnan(number(row, "pull_rms_ratio")));
    }
  }
  for (const char* law : {"rhombus", "disc_stack", "hex_sheet", "spring_patch", "hunt_crossley"})
    EXPECT_NE(std::find(families.begin(), families.end(), law), families.end()) << law;
}

TEST(Chart, ALinearReferenceJudgesTheComplianceLawAtSmallStrain) {
  const auto liver = model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", {});
  const auto truth =
      ground_truth::read_reference(TACT_SOURCE_DIR "/tests/data/reference/liver.json");
  ASSERT_TRUE(liver && truth);
  EXPECT_TRUE(liver->compliance.large_strain) << "as it is felt";
  ChartOptions options = quick();
  options.request.laws = {"compliance"};
  const report::Table table = chart_of(*liver, *truth, options);
  double best = 1.0;
  for (const report::Row& row : table.rows()) best = std::min(best, number(row, "force_rms_ratio"));
  EXPECT_LT(best, 0.005);
}

TEST(Chart, SaysWhenAPeerIsAhead) {
  const auto row = [](bool peer, double tick_us, double error) {
    ChartRow r;
    r.variant.sizes.law = "rhombus";
    r.timing.median_us = tick_us;
    r.errors.force_rms_ratio = error;
    report::Row out = table_row(r, {"s", "t", "r", "m"});
    if (peer) out.front().second = "peer";  // the kind
    return out;
  };
  report::Table table("chart");
  table.add(row(false, 1.0, 0.1));
  table.add(row(false, 2.0, 0.05));
  table.add(row(true, 3.0, 0.01));  // slower, more accurate: not ahead
  EXPECT_TRUE(peers_ahead(table).empty());
  table.add(row(true, 1.5, 0.04));  // beats the second law in both
  EXPECT_EQ(peers_ahead(table), std::vector<std::size_t>{3});
  EXPECT_EQ(front_rows(table), (std::vector<std::size_t>{0, 1}));
  // Within 10 % is the same time, but not by a chain of such steps.
  report::Table slope("chart");
  for (const auto& [tick_us, error] : {std::pair{1.0, 0.4}, {1.09, 0.3}, {1.18, 0.2}, {1.28, 0.1}})
    slope.add(row(false, tick_us, error));
  EXPECT_EQ(front_rows(slope), (std::vector<std::size_t>{1, 3}));
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
