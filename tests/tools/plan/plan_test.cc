// SPDX-License-Identifier: Apache-2.0
// The planner: the least law that is enough, why, and the file for tactd.
#include "tools/plan/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "model/io/seal.h"
#include "tests/support/damage.h"
#include "tests/support/program.h"
#include "tests/support/test_scene.h"

namespace tact::tools::plan::plan_test {

constexpr model::scene::ToleranceSettings kTolerance{
    .force_error_ratio = 0.07, .shape_error_ratio = 0.25, .tick_budget_us = 10.0};

Candidate candidate(const std::string& law, double force, double shape, double tick_us,
                    double memory_bytes) {
  return {.sizes = {.law = law},
          .force_error_ratio = force,
          .shape_error_ratio = shape,
          .tick_median_us = tick_us,
          .tick_p999_us = 2.0 * tick_us,
          .memory_bytes = memory_bytes};
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Choose, TakesTheFastestThatIsEnoughAndNamesTheRunnerUp) {
  const std::vector<Candidate> laws{
      candidate("rhombus", 0.20, 0.10, 0.05, 1e4),      // too far off
      candidate("spring_patch", 0.02, 0.10, 8.0, 1e4),  // p99.9 16 us: too slow
      candidate("compliance", 0.01, 0.05, 0.4, 1e6), candidate("hex_sheet", 0.06, 0.20, 0.1, 1e4)};
  const Choice choice = choose(laws, kTolerance);
  EXPECT_TRUE(choice.meets);
  EXPECT_EQ(choice.chosen, 3U);
  EXPECT_EQ(choice.runner_up, 2U);
  EXPECT_TRUE(has(choice.reason, "2 of 4")) << choice.reason;
  EXPECT_TRUE(has(choice.reason, "hex_sheet")) << choice.reason;
  EXPECT_TRUE(has(choice.reason, "Runner-up: compliance")) << choice.reason;
}

TEST(Choose, LetsMemoryDecideWhereTimesDoNotDiffer) {
  const std::vector<Candidate> laws{candidate("compliance", 0.01, 0.05, 0.100, 4e5),
                                    candidate("compliance", 0.02, 0.06, 0.108, 1e5),
                                    candidate("compliance", 0.03, 0.06, 0.120, 1e3)};
  const Choice choice = choose(laws, kTolerance);
  EXPECT_EQ(choice.chosen, 1U);  // 8 % slower counts as equal, 20 % does not
  ASSERT_TRUE(choice.runner_up);
  EXPECT_EQ(*choice.runner_up, 0U);
}

TEST(Choose, ReportsTheNearestAndWhatToChangeWhenNoneIsEnough) {
  const std::vector<Candidate> laws{candidate("rhombus", 0.21, 0.10, 0.05, 1e4),
                                    candidate("hex_sheet", 0.08, 0.20, 0.05, 1e4),
                                    candidate("spring_patch", 0.01, 0.20, 50.0, 1e4)};
  const Choice choice = choose(laws, kTolerance);
  EXPECT_FALSE(choice.meets);
  EXPECT_EQ(choice.chosen, 1U);
  EXPECT_FALSE(choice.runner_up);
  EXPECT_TRUE(has(choice.reason, "nearest is hex_sheet")) << choice.reason;
  EXPECT_TRUE(has(choice.reason, "force_error_ratio = 0.07")) << choice.reason;
  EXPECT_TRUE(has(choice.reason, "allow 0.08")) << choice.reason;
  EXPECT_FALSE(has(choice.reason, "tick_budget")) << choice.reason;
}

TEST(Choose, PrefersWhatKeepsTheOwnForceOfTheWholeToolToo) {
  std::vector<Candidate> laws{candidate("rhombus", 0.01, 0.10, 0.1, 1e4),
                              candidate("compliance", 0.01, 0.10, 0.4, 1e6)};
  laws[0].own_error_ratio = 0.14;  // faster, but light touch is 14 % off
  laws[1].own_error_ratio = 0.06;
  const Choice both = choose(laws, kTolerance);
  EXPECT_TRUE(both.meets);
  EXPECT_EQ(both.chosen, 1U);
  EXPECT_FALSE(both.runner_up);
  EXPECT_TRUE(has(both.reason, "of the own at worst 6 %")) << both.reason;
  laws[1].own_error_ratio = 0.09;
  const Choice none = choose(laws, kTolerance);
  EXPECT_FALSE(none.meets);
  EXPECT_EQ(none.chosen, 1U) << "the least excess, although the other is faster";
  EXPECT_TRUE(has(none.reason, "0.09 of the own force at the worst place")) << none.reason;
}

// As the shipped liver: every law misses by its own force, and two cost the same.
TEST(Choose, NeverTakesAWorseLawThanAnotherOfEqualTime) {
  std::vector<Candidate> laws{candidate("hex_sheet", 0.02, 0.10, 1.8, 1e4),
                              candidate("rhombus", 0.014, 0.10, 1.9, 1e4)};
  for (const double hex_own : {0.24, 0.091}) {
    laws[0].own_error_ratio = hex_own;
    laws[1].own_error_ratio = 0.09;
    EXPECT_EQ(choose(laws, kTolerance).chosen, 1U) << hex_own;
  }
  // Equally far off: the faster, and of equal times the smaller.
  laws[0].own_error_ratio = 0.09;
  laws[1].tick_median_us = 2.5;
  EXPECT_EQ(choose(laws, kTolerance).chosen, 0U);
  laws[1].tick_median_us = 1.9;
  laws[1].memory_bytes = 1e3;
  EXPECT_EQ(choose(laws, kTolerance).chosen, 1U);
}

TEST(Choose, NeverTakesWhatWasNotMeasured) {
  const double nan = std::nan("");
  const std::vector<Candidate> laws{
      candidate("rhombus", nan, 0.1, 0.05, 1e4), candidate("hex_sheet", 0.01, nan, 0.05, 1e4),
      candidate("disc_stack", 0.01, 0.1, nan, 1e4), candidate("spring_patch", 0.5, 0.1, 0.05, 1e4)};
  const Choice choice = choose(laws, kTolerance);
  EXPECT_FALSE(choice.meets);
  EXPECT_EQ(choice.chosen, 3U);  // the nearest that was
  EXPECT_FALSE(choose({}, kTolerance).chosen);
}

TEST(Plan, OfABladeTakesWhatCanBeCutAlone) {
  std::vector<Candidate> candidates(3);
  candidates[0].sizes.law = "compliance";
  candidates[1].sizes.law = "spring_patch";
  candidates[2].sizes.law = "rhombus";
  keep_what_cuts(candidates);
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates[0].sizes.law, "spring_patch");
}

TEST(Plan, GoesByTheWholeToolWhereTheChartHasIt) {
  report::Table table("chart");
  chart::ChartRow one, whole;
  one.variant.sizes.law = whole.variant.sizes.law = "rhombus";
  one.errors.force_rms_ratio = whole.errors.force_rms_ratio = 0.003;  // one sphere
  whole.tool.emplace();
  whole.tool->rms_ratio = 0.48;
  whole.tool->own_largest_ratio = 2.16;
  for (const chart::ChartRow& row : {one, whole}) table.add(table_row(row, {"s", "t", "r", "m"}));
  const auto candidates = candidates_of(table);
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_EQ(candidates[0].force_error_ratio, 0.003);
  EXPECT_FALSE(candidates[0].own_error_ratio);
  EXPECT_EQ(candidates[1].force_error_ratio, 0.48);
  EXPECT_EQ(candidates[1].own_error_ratio, 2.16);
}

TEST(Plan, ReadsTactsRowsOfAChart) {
  report::Table table("chart");
  const chart::Provenance here{"0123456789abcdef", "truth", "r1", model::scene::machine_name()};
  chart::ChartRow law, failed;
  law.variant.sizes = {.law = "disc_stack", .size = 7, .disc_form = "linear"};
  law.errors.force_rms_ratio = 0.125;
  failed.variant.sizes.law = "rhombus";
  failed.failure = "no meaning";
  report::Row peer = table_row(law, {here.scene_hash, here.reference_hash, "r1", "another"});
  peer.front().second = "peer";  // the kind
  table.add(table_row(law, here));
  table.add(std::move(peer));
  table.add(table_row(failed, here));
  const auto candidates = candidates_of(table);
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates[0].sizes.law, "disc_stack");
  EXPECT_EQ(candidates[0].sizes.size, 7U);
  EXPECT_EQ(candidates[0].sizes.disc_form, "linear");
  EXPECT_EQ(candidates[0].force_error_ratio, 0.125);

  model::scene::Scene scene = tests::make_plate_scene();
  EXPECT_FALSE(check_chart_fits(table, scene, "chart.json"));
  scene.hash = "another";
  const auto wrong = check_chart_fits(table, scene, "chart.json");
  ASSERT_TRUE(wrong);
  EXPECT_TRUE(has(wrong->message, "tact-lab chart plate.toml")) << wrong->message;
}

class PlanFile : public testing::Test {
 protected:
  PlanFile() {
    scene_.described = {"compliance"};
    plan_ = {.sizes = {.law = "compliance", .table_knots = 33, .size = 9},
             .tick_p999_us = 0.25,
             .force_error_ratio = 0.0123,
             .shape_error_ratio = 0.05,
             .machine = model::scene::machine_name(),
             .scene_hash = scene_.hash};
    std::filesystem::create_directories(folder_);
  }
  ~PlanFile() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text) const {
    const std::string path = folder_ + "/plan.toml";
    std::ofstream(path) << text;
    return path;
  }
  void expect_remedy(const model::Result<model::scene::Plan>& read, const std::string& what) const {
    ASSERT_FALSE(read) << what;
    EXPECT_TRUE(has(read.error().message, what)) << read.error().message;
    EXPECT_TRUE(
        has(read.error().message,
            "run tact-lab plan plate.toml --set law=auto --set 'name=\"a b\"' --reference FILE, "
            "FILE from tact-lab reference plate.toml --out FILE"))
        << read.error().message;
  }

  const std::vector<std::string> kSet{"law=auto", "name=\"a b\""};
  const std::string folder_ = testing::TempDir() + "tact_plan_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name();
  model::scene::Scene scene_ = tests::make_plate_scene();
  model::scene::Plan plan_;
};

TEST_F(PlanFile, IsFoundAgainByTheSceneAndSetsItsLawAndSizes) {
  ASSERT_EQ(setenv("XDG_CACHE_HOME", folder_.c_str(), 1), 0);
  const auto path = model::scene::plan_path(scene_.hash);
  ASSERT_TRUE(path);
  ASSERT_TRUE(model::scene::write_plan(plan_, *path));
  const auto read = model::scene::find_plan(scene_, {});
  unsetenv("XDG_CACHE_HOME");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(model::scene::plan_text(*read), model::scene::plan_text(plan_));
  scene_ = sized(scene_, read->sizes);
  EXPECT_EQ(scene_.law, "compliance");
  EXPECT_EQ(scene_.table_knots, 33U);
  EXPECT_EQ(scene_.compliance.curves, 9U);
}

TEST_F(PlanFile, OfAShippedSceneIsFoundWhenAutoIsSetForOneRun) {
  const std::string liver = std::string(TACT_SOURCE_DIR) + "/model/scenes/liver.toml";
  const auto planned = model::scene::load_scene(liver, {"rate_Hz=2000"});
  const auto run = model::scene::load_scene(liver, {"law=auto", "rate_Hz=2000"});
  const auto slower = model::scene::load_scene(liver, {"law=auto"});
  ASSERT_TRUE(planned && run && slower);
  plan_.scene_hash = planned->hash;
  ASSERT_EQ(setenv("XDG_CACHE_HOME", folder_.c_str(), 1), 0);
  ASSERT_TRUE(model::scene::write_plan(plan_, *model::scene::plan_path(planned->hash)));
  const auto found = model::scene::find_plan(*run, {"law=auto", "rate_Hz=2000"});
  const auto missing = model::scene::find_plan(*slower, {"law=auto"});
  unsetenv("XDG_CACHE_HOME");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->sizes.law, "compliance");
  ASSERT_FALSE(missing) << "the plan of another rate";
  EXPECT_TRUE(has(missing.error().message, "run tact-lab plan " + liver + " --reference"))
      << missing.error().message;
}

TEST_F(PlanFile, RefusesWhatIsMissingDamagedOrStale) {
  expect_remedy(model::scene::read_plan(folder_ + "/none.toml", scene_, kSet),
                "no plan for this scene");
  expect_remedy(model::scene::read_plan(write("law = \"comp"), scene_, kSet), "damaged");
  expect_remedy(
      model::scene::read_plan(write(model::io::sealed_text("law = \"glue\"\n")), scene_, kSet),
      "no law");
  expect_remedy(
      model::scene::read_plan(write(model::io::sealed_text("law = \"auto\"\n")), scene_, kSet),
      "no law");
  for (const char* text :
       {"law = \"compliance\"\ncurves = -3\n", "law = \"rhombus\"\ncurves = -3\n",
        "law = \"rhombus\"\ntable_knots = 1000000\n"})
    expect_remedy(model::scene::read_plan(write(model::io::sealed_text(text)), scene_, kSet),
                  "out of range");
  expect_remedy(
      model::scene::read_plan(write(model::io::sealed_text("law = \"rhombus\"\n")), scene_, kSet),
      "tick_p999_us is missing");
  model::scene::Plan other = plan_;
  other.machine = "1 x another processor";
  expect_remedy(model::scene::read_plan(write(plan_text(other)), scene_, kSet), "another machine");
  other = plan_;
  other.scene_hash = "fedcba9876543210";
  expect_remedy(model::scene::read_plan(write(plan_text(other)), scene_, kSet), "another scene");
  other = plan_;
  other.sizes.law = "hex_sheet";
  expect_remedy(model::scene::read_plan(write(plan_text(other)), scene_, kSet), "no law hex_sheet");
}

TEST_F(PlanFile, EveryDamageIsReported) {
  tests::expect_all_damage_is_reported(write(plan_text(plan_)), [&](const std::string& path) {
    const auto read = model::scene::read_plan(path, scene_, kSet);
    return !read && has(read.error().message, "damaged, its sha256");
  });
}

TEST(Program, SaysWhatIsMissing) {
  const std::string scene = std::string(TACT_SOURCE_DIR) + "/model/scenes/liver.toml";
  const auto plan = tests::run_program("tact-lab plan", scene);
  EXPECT_EQ(plan.status, 2);
  EXPECT_TRUE(has(plan.output, "give --reference FILE")) << plan.output;
  const auto chart = tests::run_program(
      "tact-lab chart", scene + " --out " + testing::TempDir() + " --reference none.json");
  EXPECT_EQ(chart.status, 2);
  EXPECT_TRUE(has(chart.output, "tact-lab reference")) << chart.output;
  EXPECT_EQ(tests::run_program("tact-lab chart", "--help").status, 0);
}

}  // namespace tact::tools::plan::plan_test
