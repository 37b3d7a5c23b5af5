// SPDX-License-Identifier: Apache-2.0
// What a report of tact-limits claims: no more than was played.
#include "tools/limits/report/limit_rows.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "hal/lines_settings.h"
#include "tests/support/program.h"
#include "tests/support/test_scene.h"
#include "tools/limits/run_plan.h"

namespace tact::tools::limits::limit_rows_test {

using model::Limits;
using tests::Outcome;

std::string folder() {
  return testing::TempDir() + "tact-limits-report-" + std::to_string(getpid());
}
Outcome run(const std::string& arguments) {
  return tests::run_program("tact-limits", std::string("--scene ") + TACT_SOURCE_DIR +
                                               "/model/scenes/liver.toml --out " + folder() +
                                               " --no-pictures " + arguments);
}
std::string read(const std::string& name) {
  std::ifstream file(folder() + "/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

LimitsReport plan(const std::string& names, Limits (*gate_limits)(const Limits&) = nullptr) {
  const auto report = run_plan(
      tests::make_plate_scene(),
      {.cases = *choose_cases(names), .wall = names_wall(names), .gate_limits = gate_limits});
  EXPECT_TRUE(report) << (report ? "" : report.error().message);
  return report ? *report : LimitsReport{};
}
Limits larger_force(const Limits& limits) {
  Limits wrong = limits;
  wrong.force_N *= 1.05;
  return wrong;
}
Limits larger_continuous_force(const Limits& limits) {
  Limits wrong = limits;
  wrong.continuous_force_N *= 1.05;
  return wrong;
}

Limits larger_grip_force(const Limits& limits) {
  Limits wrong = limits;
  wrong.grip_force_N *= 1.05;
  return wrong;
}

TEST(LimitRows, TheFingersGetUpToTheirLimitAndNeverMore) {
  const LimitsReport good = plan("fingers");
  EXPECT_EQ(good.result_text(), "PASS of 1 of 26 cases");
  const LimitRow row = limit_rows(good).at(static_cast<std::size_t>(Bound::kGrip));
  EXPECT_NEAR(row.largest, row.limit, 1e-9);
  EXPECT_GT(row.limit, 0.0);
  EXPECT_EQ(row.kept, Kept::kPass);
  const LimitsReport wrong = plan("fingers", larger_grip_force);
  EXPECT_EQ(wrong.result_text(), "FAIL");
  EXPECT_EQ(limit_rows(wrong).at(static_cast<std::size_t>(Bound::kGrip)).kept, Kept::kFail);
}

TEST(LimitRows, HaveTheSceneAndThisPcBesideWhatWasTested) {
  LimitsReport report = plan("ramp");
  EXPECT_EQ(report.scene_limits.force_N, tests::make_plate_scene().limits.force_N);
  const double share = report.pc_limits.force_N / report.limits.force_N;
  EXPECT_TRUE(share == 1.0 || share == 0.25) << share;
  report.scene_limits.force_N = 3.0;
  report.limits.force_N = 2.0;
  report.pc_limits.force_N = 0.5;
  const LimitRow row = limit_rows(report).at(static_cast<std::size_t>(Bound::kForce));
  EXPECT_EQ(row.scene.limit, 3.0);
  EXPECT_EQ(row.limit, 2.0);
  EXPECT_EQ(row.pc.limit, 0.5);
}

TEST(LimitRows, WithoutAForceOnTheFingersTheirCaseIsNotRun) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.limits.grip_force_N = 0.0;
  const auto report = run_plan(scene, {.cases = *choose_cases("fingers,ramp"), .wall = false});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->cases.size(), 1u);
  EXPECT_EQ(report->not_run.front().why, kNoGripForce);
}

// A wall alone once made a green page that said pass of eight limits that were not approached.
TEST(LimitRows, APartOfThePlanPassesNoLimitThatItDidNotReach) {
  const Outcome out = run("--plan stiff-wall --json");
  EXPECT_EQ(out.status, 0) << out.output;
  const auto report = nlohmann::json::parse(out.output);
  EXPECT_EQ(report.at("result"), "PASS of 1 of 26 cases");
  EXPECT_EQ(report.at("limits").size(), 9u);
  const auto& wall = report.at("wall");  // README.md and tools/README.md state these
  EXPECT_NEAR(wall.at("bounded_ratio"), 11.6, 0.1);
  EXPECT_NEAR(wall.at("rest_without_N_per_m"), 2644.0, 1.0);
  EXPECT_EQ(wall.at("rest_ratio"), 1.0);
  EXPECT_NEAR(wall.at("largest_swing_without_m"), 0.020, 0.001);
  EXPECT_NEAR(wall.at("largest_swing_with_m"), 0.0033, 0.0001);
  for (const auto& row : report.at("limits")) EXPECT_EQ(row.at("kept"), "not reached") << row;
  const std::string page = read("limits.html");
  EXPECT_NE(page.find("PASS of 1 of 26 cases: "), std::string::npos);
  EXPECT_EQ(page.find("verdict pass"), std::string::npos) << "it is not green";
  EXPECT_EQ(page.find("in all"), std::string::npos);
  for (const char* words : {"bounded up to 75146 N/m", "2644 N/m with it: 1.0 times as stiff",
                            "20 mm without the stage, 3.3 mm with it"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  EXPECT_EQ(report.at("not_run").size(), all_cases().size());
  for (const Case& c : all_cases())
    EXPECT_NE(page.find(c.name), std::string::npos) << c.name << " is not named on the page";
  std::filesystem::remove_all(folder());
}

TEST(LimitRows, ALimitIsPassedWhereACaseReachedItAndATighterOneIsShownAsSuch) {
  const std::vector<LimitRow> whole = limit_rows(plan("all"));
  const auto row = [&](Bound bound) { return whole.at(static_cast<std::size_t>(bound)); };
  for (const Bound bound : {Bound::kForce, Bound::kTorque, Bound::kStep, Bound::kTorqueStep,
                            Bound::kEnergy, Bound::kGrip}) {
    EXPECT_EQ(row(bound).kept, Kept::kPass) << row(bound).name;
    EXPECT_GT(row(bound).largest, (bound == Bound::kEnergy ? 0.5 : 0.95) * row(bound).limit)
        << row(bound).name;
  }
  const std::pair<Bound, std::string> tightened[] = {{Bound::kPower, "power"},

                                                     {Bound::kRms, "continuous"},
                                                     {Bound::kTorqueRms, "warm-torque"}};
  for (const auto& [bound, name] : tightened) {
    EXPECT_EQ(row(bound).kept, Kept::kPassTighter) << name;
    ASSERT_EQ(row(bound).tighter.size(), 1u) << name;
    const TighterLimit own = row(bound).tighter[0];
    EXPECT_EQ(own.case_name, name);
    EXPECT_LT(own.limit, row(bound).limit) << name;
    EXPECT_GT(own.largest, 0.3 * own.limit) << name;
    EXPECT_LE(own.largest, own.limit * (1.0 + 1e-9)) << name;
  }
  const std::vector<LimitRow> ramp = limit_rows(plan("ramp"));
  for (std::size_t i = 0; i < ramp.size(); ++i)
    EXPECT_EQ(ramp[i].kept, i == 0 ? Kept::kPass : Kept::kNotReached) << ramp[i].name;
  EXPECT_EQ(limit_rows(plan("ramp", larger_force))[0].kept, Kept::kFail);
  EXPECT_EQ(limit_rows(plan("continuous", larger_continuous_force))[6].kept, Kept::kFail);
}

TEST(LimitRows, ALineIsTestedWhereItIsWiredAndNowhereElse) {
  hal::LinesSettings wired;
  wired.chip = "lines";
  for (const Case& c : all_cases()) {
    EXPECT_EQ(why_left_out(c, {}) != nullptr,
              opens_line(c) || c.hand != HandMove::kStill || c.grip == Grip::kJaws)
        << c.name;
    if (opens_line(c)) EXPECT_NE(why_left_out(c, wired), nullptr) << "a chip alone is no line";
  }
  wired.estop_b = 3;
  const std::vector<Case> cases = *choose_cases("e-stop,dead-man");
  EXPECT_EQ(why_left_out(cases[0], wired), nullptr);
  EXPECT_NE(why_left_out(cases[1], wired), nullptr);
  wired.dead_man = 4;
  EXPECT_EQ(why_left_out(cases[1], wired), nullptr);
}

TEST(LimitRows, ARealDeviceSaysThatNoContactWasOpened) {
  LimitsReport report = plan("e-stop,dead-man,step");
  for (const auto& one : to_json(report).at("cases"))
    EXPECT_EQ(one.at("cause"), "played") << "simulated lines do open";
  report.simulated = false;
  const nlohmann::json cases = to_json(report).at("cases");
  EXPECT_EQ(cases.at(0).at("cause"), kReportedInSoftware);
  EXPECT_EQ(cases.at(1).at("cause"), kReportedInSoftware);
  EXPECT_EQ(cases.at(2).at("cause"), "played");
}

}  // namespace tact::tools::limits::limit_rows_test
