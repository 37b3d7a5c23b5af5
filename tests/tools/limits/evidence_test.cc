// SPDX-License-Identifier: Apache-2.0
// Can a report of tact-limits be filed: who, where, what exactly, and which hazards it is about?
#include "tools/limits/evidence/evidence.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "model/io/input_file.h"
#include "model/io/limits_checksum.h"
#include "model/io/program/installed.h"
#include "model/io/seal.h"
#include "tests/support/program.h"
#include "tests/support/test_scene.h"
#include "tools/limits/evidence/hazards.h"
#include "tools/limits/run_plan.h"

namespace tact::tools::limits::evidence_test {

using model::Limits;
using nlohmann::json;
using tests::Outcome;

const std::string kLiver = std::string(TACT_SOURCE_DIR) + "/model/scenes/liver.toml";
std::string folder() {
  return testing::TempDir() + "tact-limits-evidence-" + std::to_string(getpid());
}
Outcome run(const std::string& arguments) {
  return tests::run_program(
      "tact-limits",
      kLiver + " --out " + folder() + " --no-pictures --plan step,e-stop --json " + arguments);
}
std::string page() {
  const auto text = model::io::read_file(folder() + "/limits.html");
  return text ? *text : "";
}

TEST(Evidence, ReportNamesTesterLocationSerialNumbersAndDigests) {
  const Outcome out =
      run("--tester 'A. B.' --location 'room <1>' --serial 'delta 42' --serial 'PC 7'");
  ASSERT_EQ(out.status, 0) << out.output;
  const json report = json::parse(out.output);
  const json& filed = report.at("report");
  EXPECT_EQ(filed.at("tester"), "A. B.");
  EXPECT_EQ(filed.at("serial_numbers"), (json{"delta 42", "PC 7"}));
  const std::string number = filed.at("number");
  EXPECT_NE(number.find(report.at("limits_checksum").get<std::string>()), std::string::npos);
  const std::string text = page();
  for (const std::string& words :
       {number, std::string("A. B."), std::string("room &lt;1&gt;"), std::string("delta 42; PC 7"),
        filed.at("host").get<std::string>(), report.at("sha256").at("tactd").get<std::string>()})
    EXPECT_NE(text.find(words), std::string::npos) << words;
  EXPECT_LT(text.find("class=\"verdict"), text.find("<h1>")) << "the verdict is first";
  EXPECT_NE(text.find("<span class=simulated>SIMULATED</span>PASS"), std::string::npos);
  EXPECT_NE(text.find("It claims conformity with no standard"), std::string::npos);
  EXPECT_NE(text.find("counter(page) \" of \" counter(pages)"), std::string::npos);
  std::filesystem::remove_all(folder());
}

TEST(Evidence, ItsDigestsAreThoseOfTheFilesAndItsChecksumIsTactds) {
  const json report = json::parse(run("--set limits.force_N=3").output);
  const auto digest_of = [](const std::string& path) {
    return model::io::sha256_of(*model::io::read_file(path));
  };
  const json& digests = report.at("sha256");
  EXPECT_EQ(digests.at("scene"), digest_of(kLiver));
  EXPECT_EQ(digests.at("tact_limits"), digest_of(tests::program_path("tact-limits")));
  EXPECT_EQ(digests.at("tactd"), digest_of(tests::program_path("tactd")));
  EXPECT_EQ(report.at("scene_text"), *model::io::read_file(kLiver));
  EXPECT_EQ(report.at("overrides"), json{"limits.force_N=3"});
  const Outcome tactd = tests::run_program(
      "tactd", kLiver + " --set limits.force_N=3 --free-run --ticks 10 --no-telemetry --json -");
  EXPECT_EQ(json::parse(tactd.output).at("limits_checksum"), report.at("limits_checksum"));
  std::filesystem::remove_all(folder());
}

TEST(Evidence, AReportNumberThatCannotStandInAFootIsRefused) {
  EXPECT_FALSE(check_number("Q-12/2026 rev_3.1"));
  for (const char* bad : {"a\"}", "a<b>", "a;b"}) EXPECT_TRUE(check_number(bad)) << bad;
  EXPECT_TRUE(check_number(std::string(61, 'a')));
}

Limits larger_force(const Limits& limits) {
  Limits wrong = limits;
  wrong.force_N *= 1.05;
  return wrong;
}

TEST(HazardMatrix, ShowsWhatThisRunHasShownAndNoMore) {
  const auto report = run_plan(tests::make_plate_scene(),
                               {.cases = *choose_cases("ramp,step"), .gate_limits = larger_force});
  ASSERT_TRUE(report);
  const json rows = hazards_json(*report).at("hazards");
  const auto here = [&](std::size_t hazard) {
    return rows.at(hazard).at("requirements").at(0).at("in_this_run");
  };
  EXPECT_EQ(rows.at(0).at("id"), "HZ-01");
  EXPECT_EQ(here(0).at("ramp"), "FAIL");
  EXPECT_EQ(here(0).at("torque"), "not played");
  EXPECT_EQ(here(2).at("chatter"), "not played");
}

TEST(HazardMatrix, EachTestHasAResultWithDateAndRevisionWhereOneIsKnown) {
  // Beside this program, as beside tact-limits where it is installed.
  const auto path = model::io::program_folder() / "test_results.json";
  std::ofstream(path)
      << R"({"format": "tact-test-results", "tests": {"TEST-01": {"result": "pass",)"
      << R"( "date": "2026-11-30", "revision": "1a2b3c"}}})";
  const auto report = run_plan(tests::make_plate_scene(), {.cases = *choose_cases("ramp,step")});
  ASSERT_TRUE(report);
  std::map<std::string, json> of;
  const json table = hazards_json(*report);
  for (const json& row : table.at("tests")) of[row.at("id")] = row;
  std::filesystem::remove(path);
  EXPECT_EQ(of.at("TEST-01").at("result"), "pass");
  EXPECT_EQ(of.at("TEST-01").at("date"), "2026-11-30");
  EXPECT_EQ(of.at("TEST-01").at("revision"), "1a2b3c");
  EXPECT_EQ(of.at("TEST-02").at("result"), "not known here");
  std::set<std::string> own;
  for (const auto& [id, row] : of) {
    EXPECT_EQ(row.at("by").get<std::string>().find("build/"), std::string::npos) << id;
    if (row.at("by") == "tact-limits") own.insert(row.at("result").get<std::string>());
  }
  EXPECT_EQ(own, std::set<std::string>{"not played"}) << "a row of which one case was not played";
}

TEST(HazardMatrix, EachHazardHasARequirementAndEachRequirementATest) {
  std::size_t requirements = 0;
  for (const Hazard& hazard : hazard_table()) {
    EXPECT_FALSE(hazard.requirements.empty()) << hazard.id;
    for (const Requirement& one : hazard.requirements) {
      ++requirements;
      EXPECT_FALSE(one.tests.empty()) << one.id;
      for (const HazardTest& test : one.tests) EXPECT_FALSE(test.names.empty()) << test.id;
    }
  }
  EXPECT_GE(requirements, 30u);
  EXPECT_GT(hazard_tests().size(), 60u);
}

}  // namespace tact::tools::limits::evidence_test
