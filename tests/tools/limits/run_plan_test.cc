// SPDX-License-Identifier: Apache-2.0
// The plan of tact-limits: it passes on a sound gate, and each broken limit makes a case fail.
#include "tools/limits/run_plan.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "firmware/loop/alloc_counter.h"
#include "tests/support/program.h"
#include "tests/support/stub_dhd/stub_client.h"
#include "tests/support/test_scene.h"
#include "tools/limits/real_device/consent.h"
#include "tools/limits/report/limit_rows.h"

namespace tact::tools::limits::run_plan_test {

using firmware::gate::Stage;
using model::Limits;
using tests::Outcome;

std::string folder() { return testing::TempDir() + "tact-limits-" + std::to_string(getpid()); }
Outcome run(const std::string& arguments) { return tests::run_program("tact-limits", arguments); }
std::string liver() {
  return std::string("--scene ") + TACT_SOURCE_DIR + "/model/scenes/liver.toml";
}

LimitsReport plan(const std::string& names, Limits (*gate_limits)(const Limits&) = nullptr,
                  double rate_Hz = 1000.0) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.rate_Hz = rate_Hz;
  const auto report = run_plan(
      scene,
      {.cases = *choose_cases(names), .wall = names_wall(names), .gate_limits = gate_limits});
  EXPECT_TRUE(report) << (report ? "" : report.error().message);
  return report ? *report : LimitsReport{};
}
/// The messages of all checks of the only case that do not hold.
std::string broken(const LimitsReport& report) {
  std::string all;
  for (const Check& check : report.cases.at(0).verdict.checks)
    if (!check.holds) all += check.message + "; ";
  return all;
}

TEST(RunPlan, EveryCasePassesOnASoundGate) {
  const LimitsReport report = plan("all");
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(report.cases.size(), all_cases().size());
  EXPECT_EQ(limit_rows(report).size(), check_bounds({}, report.limits, report.period_s).size());
  std::uint32_t acted = 0;
  for (const CaseResult& result : report.cases) {
    EXPECT_EQ(result.verdict.overshoot_N, 0.0) << result.verdict.subject.name;
    acted |= result.verdict.acted;
  }
  for (const Stage stage : {Stage::kFinite, Stage::kFresh, Stage::kArmed, Stage::kWorkspace,
                            Stage::kPassivity, Stage::kMagnitude, Stage::kSlew, Stage::kPower})
    EXPECT_NE(acted >> static_cast<unsigned>(stage) & 1u, 0u)
        << firmware::gate::kStageName[static_cast<std::size_t>(stage)];
  ASSERT_TRUE(report.wall);
  const WallVerdict& wall = *report.wall;
  EXPECT_GT(wall.bounded_ratio(), 2.0);
  EXPECT_GT(wall.bounded_without_N_per_m, wall.theory_N_per_m);
  // the stage bounds a motion; it does not bring it to rest on a stiffer wall
  EXPECT_EQ(wall.rest_ratio(), 1.0);
  EXPECT_GT(wall.rest_without_N_per_m, wall.theory_N_per_m);
  EXPECT_LT(wall.rest_without_N_per_m, wall.bounded_without_N_per_m);
  EXPECT_LT(wall.swing_with_m, 0.5 * wall.swing_without_m);
  EXPECT_GT(wall.swing_with_m, 1e-4);
}

TEST(RunPlan, TimesToZeroHoldAtEveryRate) {
  for (const double rate_Hz : {250.0, 500.0, 2000.0}) {
    const LimitsReport report =
        plan("stale-samples,lost-device,late-ticks,speed,workspace,e-stop", nullptr, rate_Hz);
    EXPECT_TRUE(report.passed()) << rate_Hz << " Hz\n" << to_text(report);
  }
}

// A gate with one limit too large: a mutant of each stage, by its settings.
struct Mutant {
  const char* plan;
  Limits (*gate_limits)(const Limits&);
  const char* message;  // the check that must see it
};
template <double Limits::* Key>
Limits enlarged(const Limits& limits) {
  Limits wrong = limits;
  wrong.*Key *= 1.05;
  return wrong;
}
template <double Limits::* Key>
Limits without(const Limits& limits) {
  Limits wrong = limits;
  wrong.*Key = 1e6;
  return wrong;
}
Limits alike(const Limits& limits) { return limits; }

TEST(RunPlan, AGateWithOneLimitTooLargeFails) {
  for (const Mutant& mutant :
       {Mutant{"ramp", enlarged<&Limits::force_N>, "largest force"},
        Mutant{"diagonal", enlarged<&Limits::force_N>, "largest force"},
        Mutant{"torque", enlarged<&Limits::torque_Nm>, "largest torque"},
        Mutant{"step", enlarged<&Limits::slew_N_per_s>, "largest change"},
        Mutant{"sign-flip", enlarged<&Limits::slew_N_per_s>, "largest change"},
        Mutant{"continuous", enlarged<&Limits::continuous_force_N>, "largest RMS"},
        Mutant{"warm-torque", enlarged<&Limits::continuous_force_N>, "RMS of the torque"},
        Mutant{"power", without<&Limits::power_W>, "largest power"},
        Mutant{"active-law", without<&Limits::energy_J>, "energy given"},
        Mutant{"speed", without<&Limits::speed_mps>, "workspace did not act"},
        Mutant{"workspace", without<&Limits::workspace_radius_m>, "never came to zero"}}) {
    const LimitsReport wrong = plan(mutant.plan, mutant.gate_limits);
    EXPECT_FALSE(wrong.passed()) << mutant.plan;
    EXPECT_NE(broken(wrong).find(mutant.message), std::string::npos)
        << mutant.plan << ": " << broken(wrong);
    EXPECT_TRUE(plan(mutant.plan, alike).passed()) << mutant.plan;
  }
}

TEST(RunPlan, TwentyLateTicksAreAllowedInHardRealTimeMoreWithout) {
  const auto cases = choose_cases("late-ticks");
  ASSERT_TRUE(cases);
  EXPECT_NEAR(*at_rate(cases->at(0), 0.001, true).expected.zero_within_s, 0.042, 1e-12);
  EXPECT_NEAR(*at_rate(cases->at(0), 0.001, false).expected.zero_within_s, 0.250, 1e-12);
}

TEST(RunPlan, OvershootIsWhatIsAboveTheLimit) {
  const LimitsReport wrong = plan("ramp", enlarged<&Limits::force_N>);
  EXPECT_NEAR(wrong.cases.at(0).verdict.overshoot_N, 0.05 * 8.0, 1e-9);
}

TEST(RunPlan, AWallWithoutThePassivityStageIsNoStiffer) {
  const LimitsReport wrong = plan("stiff-wall", without<&Limits::energy_J>);
  ASSERT_TRUE(wrong.wall);
  EXPECT_EQ(wrong.wall->bounded_ratio(), 1.0);
  EXPECT_FALSE(wrong.passed());
}

TEST(RunPlan, ACaseInWhichNothingHappensFails) {
  const model::scene::Scene scene = tests::make_plate_scene();
  for (Case c : {all_cases()[0], all_cases()[7], all_cases()[13]}) {
    c.size = 0.0;  // no force
    c.shape = Shape::kHold;
    c.injected = InjectedFault::kNone;  // and no cause
    const auto report = run_plan(scene, {.cases = {c}});
    ASSERT_TRUE(report);
    EXPECT_FALSE(report->passed()) << c.name;
  }
}

TEST(Consent, OnlyTheExactConsentTextIsAccepted) {
  const auto agrees = [](const std::string& typed) {
    std::istringstream in(typed);
    return !read_consent(in, 8.0);
  };
  EXPECT_TRUE(agrees("I hold the device and allow 8 N\n"));
  for (const char* no : {"", "yes\n", "I hold the device and allow 80 N\n",
                         "i hold the device and allow 8 N\n", "I hold the device and allow 8 N \n"})
    EXPECT_FALSE(agrees(no)) << no;
}

TEST(Limits, HelpAndListNameWhatTheyMust) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* word : {"--plan", "--list", "--out", "--scene", "--json", "Exit status"})
    EXPECT_NE(help.output.find(word), std::string::npos) << word;
  const Outcome list = run("--list");
  EXPECT_EQ(list.status, 0);
  for (const Case& c : all_cases()) EXPECT_NE(list.output.find(c.name), std::string::npos);
  EXPECT_NE(list.output.find(kWallName), std::string::npos);
}

TEST(Limits, BadOptionsAreOneLineAndStatusTwo) {
  const std::string to = " --out " + folder();
  for (const std::string& bad :
       {std::string(""), liver(), liver() + to + " --plan nonsense", to + " --scene /none.toml",
        liver() + " --out /proc/none", liver() + to + " --nonsense", liver() + to + " --plan ''"}) {
    const Outcome out = run(bad);
    EXPECT_EQ(out.status, 2) << bad << "\n" << out.output;
    EXPECT_EQ(out.output.find("tact-limits: "), 0u) << out.output;
    EXPECT_EQ(std::count(out.output.begin(), out.output.end(), '\n'), 1) << out.output;
  }
  std::filesystem::remove_all(folder());
}

std::string read(const std::string& name) {
  std::ifstream file(folder() + "/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Limits, APassedReportHasAllFilesAndLoadsNothing) {
  const Outcome out = run(liver() + " --out " + folder() + " --plan step,e-stop --json");
  EXPECT_EQ(out.status, 0) << out.output;
  const auto report = nlohmann::json::parse(out.output);
  EXPECT_TRUE(report.at("passed").get<bool>());
  EXPECT_EQ(report.at("cases").at(1).at("time_to_zero_s"), 0.0);
  for (const char* file : {"cases.csv", "trace_step.csv", "trace_e-stop.csv", "curves.svg"})
    EXPECT_TRUE(std::filesystem::exists(folder() + "/" + file)) << file;
  const std::string page = read("limits.html");
  EXPECT_NE(page.find("PASS of 2 of 26 cases: "), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_LT(page.find("class=\"verdict"), page.find("<h2>Limits"));
  EXPECT_LT(page.find("<h2>Limits"), page.find("<h2>Cases"));
  for (const char* loaded : {"src=", "<link", "@import", "<script"})
    EXPECT_EQ(page.find(loaded), std::string::npos) << loaded;
  std::filesystem::remove_all(folder());
}

TEST(Limits, AFailedCaseIsStatusOneAndSaysWhy) {
  // a hand does not reach 10 m/s: the stage had nothing to do, so nothing is proved
  const Outcome out = run(liver() + " --out " + folder() +
                          " --plan step,speed --no-pictures --set limits.speed_mps=10 --set "
                          "limits.energy_J=1");
  EXPECT_EQ(out.status, 1) << out.output;
  EXPECT_NE(out.output.find("FAIL: the stage workspace did not act"), std::string::npos)
      << out.output;
  const std::string page = read("limits.html");
  EXPECT_NE(page.find("FAIL: 1 of 2 cases"), std::string::npos);
  std::filesystem::remove_all(folder());
}

std::string real_device() {
  return liver() + " --out " + folder() +
         " --plan ramp,nan-force,speed,e-stop,e-stop-released,dead-man --no-pictures --set "
         "'device.kind=\"force-dimension\"' --trust-library --set "
         "'device.force_dimension.library=\"" +
         tests::kStubLibrary + "\"'";
}

/// For the shell: standard input with these words.
std::string typed(const std::string& words) {
  const std::string path = testing::TempDir() + "tact-limits-words-" + std::to_string(getpid());
  std::ofstream(path) << words << "\n";
  return " < " + path;
}

TEST(Limits, RealDeviceDoesNotMoveWithoutTheExactConsentText) {
  const Outcome piped = run(real_device() + " < /dev/null");
  EXPECT_EQ(piped.status, 2);
  EXPECT_NE(piped.output.find("asks on a terminal first"), std::string::npos) << piped.output;
  for (const char* words : {"", "yes", "I hold the device and allow 9 N"}) {
    const Outcome out = run("--consent-from-stdin " + real_device() + typed(words));
    EXPECT_EQ(out.status, 2);
    EXPECT_NE(out.output.find("WARNING: force-dimension will push with up to 8 N"),
              std::string::npos)
        << out.output;
    EXPECT_NE(out.output.find("not agreed to: nothing moved"), std::string::npos) << out.output;
  }
  EXPECT_FALSE(std::filesystem::exists(folder() + "/limits.json"));
  std::filesystem::remove_all(folder());
}

TEST(Limits, ARealDeviceIsTestedAfterTheWordsAndSaysWhatWasNotRun) {
  const Outcome out =
      run("--consent-from-stdin --json " + real_device() + typed(consent_text(8.0)));
  const std::size_t begin = out.output.find('{');  // after the warning
  ASSERT_NE(begin, std::string::npos) << out.output;
  const auto report = nlohmann::json::parse(out.output.substr(begin));
  EXPECT_FALSE(report.at("simulated").get<bool>());
  EXPECT_EQ(report.at("call_filter").get<bool>(), !firmware::loop::is_sanitized()) << out.output;
  EXPECT_EQ(report.at("cases").size(), 2u);
  EXPECT_EQ(report.at("not_run").at(0).at("case"), "speed");
  EXPECT_EQ(report.at("not_run").at(0).at("why"), "needs the simulated hand");
  // the scene wires no line: a fault set in its place would be a test that did not happen
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_EQ(report.at("not_run").at(i).at("why"),
              i < 3 ? "no emergency stop is wired" : "no dead-man switch is wired");
  for (const auto& c : report.at("cases")) EXPECT_NE(c.at("case"), "e-stop");
  EXPECT_EQ(report.at("not_run").size(), 24u) << "and all that were not asked for";
  for (const auto& c : report.at("cases")) EXPECT_EQ(c.at("overshoot_N"), 0.0) << out.output;
  std::filesystem::remove_all(folder());
}

}  // namespace tact::tools::limits::run_plan_test
