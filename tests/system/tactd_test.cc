// SPDX-License-Identifier: Apache-2.0
// tactd as a person uses it: its command line, its files, its end.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "firmware/pc/pc_files.h"
#include "model/fault.h"
#include "model/scene/plan_file.h"
#include "tests/support/measured_files.h"
#include "tests/system/tactd_fixture.h"

namespace tact::tests::tactd_test {

using nlohmann::json;

TEST_F(Tactd, ChecksAGoodSceneAndLeaves) {
  const Outcome outcome = tactd(kLiver + " --check");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  for (const char* part :
       {"sound", "force of the whole tool: ", " % of the peak off (RMS)",
        "against linear finite elements at 5 places, 4 left out by finite strain, with "
        "compliance.large_strain off, which this scene has on; measured 20",
        ", hash ", "law rhombus chain", "stiffness ", " of 354.", " of 50 us a tick",
        "largest felt slope ", " N/m at vertex ", " of 33 presses of the whole tool"})
    EXPECT_TRUE(has(outcome, part)) << part << " in: " << outcome.output;
}

TEST_F(Tactd, ProofReadsASceneOfHardwareAtTheDesk) {
  const std::string falcon =
      kLiver +
      " --check --set 'device.kind=\"falcon\"' --set "
      "device.lines.chip=none --set device.lines.estop_a=1 --set device.lines.estop_b=2";
  const Outcome plugged = tactd(falcon);
  EXPECT_EQ(plugged.status, 2) << "no Falcon and no such chip is here: " << plugged.output;
  const Outcome desk = tactd(falcon + " --no-device");
  EXPECT_EQ(desk.status, 0) << desk.output;
  EXPECT_TRUE(has(desk, "falcon and lines are not opened") && has(desk, ": sound")) << desk.output;
  EXPECT_EQ(tactd(falcon + " --no-device --set device.falcon.no_such_key=1").status, 2);
  EXPECT_EQ(tactd(kLiver + " --no-device").status, 2) << "it would run without its device";
}

TEST_F(Tactd, RefusesALawThatNeedsMoreThanHalfAPeriod) {
  const std::string slow = TACT_SOURCE_DIR
      "/model/scenes/gum.toml --set spring_patch.integrator=implicit-euler --set "
      "spring_patch.iterations=100 --set spring_patch.substeps=16 --set spring_patch.nodes=1024";
  const Outcome refused = tactd(slow + " --check");
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(has(refused, "half a period of rate_Hz is 500 us")) << refused.output;
  const Outcome simulated = tactd(slow + " --free-run --ticks 1");
  EXPECT_EQ(simulated.status, 0) << "simulated time waits: " << simulated.output;
}

TEST_F(Tactd, NamesFileAndLineOfABadScene) {
  const std::string bad = in_folder("bad.toml");
  std::ifstream good(kLiver);
  std::ofstream file(bad);
  std::string line;
  for (int number = 1; std::getline(good, line); ++number)
    file << (number == 3 ? "surprise_m = 1.0\n" : "") << line << '\n';
  file.close();
  const auto outcome = tactd(bad);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(has(outcome, bad + ":3: ") && has(outcome, "surprise_m")) << outcome.output;
}

TEST_F(Tactd, RefusesBadUsageWithStatusTwo) {
  EXPECT_EQ(tactd("").status, 2);
  EXPECT_EQ(tactd("/nowhere.toml").status, 2);
  EXPECT_EQ(tactd(kLiver + " --unknown").status, 2);
  EXPECT_EQ(tactd(kLiver + " --set no_such_key=1").status, 2);
  EXPECT_EQ(tactd(kLiver + " --free-run").status, 2);
  EXPECT_EQ(tactd("--help").status, 0);
  const Outcome outcome = tactd(kLiver + " --seconds -1");
  EXPECT_EQ(outcome.output.rfind("tactd: --seconds", 0), 0u) << outcome.output;
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << "one line";
}

TEST_F(Tactd, NeverRunsHardwareOnSimulatedTime) {
  const Outcome refused = tactd(kLiver + " --free-run --ticks 9 --set 'device.kind=\"falcon\"'");
  EXPECT_TRUE(has(refused, "--free-run is simulated time")) << refused.output;
}

TEST_F(Tactd, KnowsNoLawAsPrinted) {
  const Outcome outcome = tactd(kLiver + " --set law=rhombus_paper_literal --ticks 1");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(has(outcome, "rhombus_paper_literal")) << outcome.output;
}

TEST_F(Tactd, PrintsEveryFaultWithItsRemedy) {
  const Outcome outcome = tactd("--faults");
  EXPECT_EQ(outcome.status, 0);
  for (const auto& entry : tact::model::fault_table()) EXPECT_TRUE(has(outcome, entry.remedy));
  const json words = json::parse(tactd("--faults --json -").output);
  EXPECT_EQ(words.at("faults").size(), tact::model::fault_table().size());
  ASSERT_EQ(words.at("states").size(), 4U) << "by number, for the page";
  EXPECT_EQ(words.at("states")[2].at("name"), "armed");
}

TEST_F(Tactd, CitesItselfWithTheCommitOfItsBuild) {
  std::ifstream file(TACT_SOURCE_DIR "/.github/CITATION.cff");
  ASSERT_TRUE(file);
  const std::string citation{std::istreambuf_iterator<char>(file), {}};
  const Outcome out = tactd("--cite");
  EXPECT_EQ(out.status, 0);
  ASSERT_TRUE(out.output.starts_with(citation)) << out.output;
  const std::string commit = out.output.substr(citation.size());
  EXPECT_TRUE(commit.starts_with("commit: \"") && commit.ends_with("\"\n")) << commit;
  const std::string version = tactd("--version").output;
  EXPECT_NE(version.find("(" + commit.substr(9, commit.size() - 11) + ")"), std::string::npos)
      << version;
}

TEST_F(Tactd, AReportHoldsEveryNumberThatProvesARun) {
  const json report = report_of(kLiver + " --free-run --seconds 5");
  EXPECT_EQ(report.at("ticks"), 5000);
  EXPECT_EQ(report.at("law").get<std::string>().rfind("rhombus chain", 0), 0u);
  for (const char* key : {"late", "skipped", "force_max_N", "gate", "fault", "non_rt"})
    EXPECT_TRUE(report.contains(key)) << key;
  for (const char* key : {"allocations", "minor_page_faults", "major_page_faults",
                          "voluntary_context_switches", "involuntary_context_switches"})
    EXPECT_TRUE(report.at("thread").contains(key)) << key;
  for (const char* phase :
       {"wake", "read", "detect", "render", "limit", "write", "publish", "total"})
    for (const char* key : {"p50_ns", "p99_ns", "p99.9_ns", "p99.99_ns", "max_ns", "max_tick"})
      EXPECT_TRUE(report.at("phases").at(phase).contains(key)) << phase << " " << key;
  for (const char* stage : {"finite", "fresh", "armed", "workspace", "magnitude", "slew", "ramp"})
    EXPECT_TRUE(report.at("gate").contains(stage)) << stage;
  for (const char* key :
       {"kernel_release", "realtime_kernel", "cpu", "clock_source", "git_revision", "scene_hash"})
    EXPECT_TRUE(report.at("environment").contains(key)) << key;
}

TEST_F(Tactd, TwoRunsOnSimulatedTimeGiveTheSameForces) {
  const json a = report_of(kLiver + " --free-run --seconds 5");
  const json b = report_of(kLiver + " --free-run --seconds 5");
  EXPECT_EQ(a.at("force_hash"), b.at("force_hash"));
  EXPECT_NE(a.at("force_hash"), "0000000000000000");
  const json c = report_of(kLiver + " --free-run --seconds 5 --set rhombus.growth=2.1");
  EXPECT_NE(a.at("force_hash"), c.at("force_hash"));
}

TEST_F(Tactd, ReplaysARealTimeRunBitForBit) {
  const std::string log = in_folder("run.tactlog");
  report_of(kLiver + " --ticks 4000 --record " + log);
  const Outcome replayed = tactd(kLiver + " --replay " + log);
  EXPECT_EQ(replayed.status, 0) << replayed.output;
  EXPECT_TRUE(has(replayed, "4000 ticks computed again, 0 differ")) << replayed.output;
  EXPECT_EQ(tactd(kLiver + " --set rhombus.growth=2.1 --replay " + log).status, 2);
  EXPECT_EQ(tactd(kLiver + " --ticks 1 --record " + log).status, 2) << "never overwritten";
}

TEST_F(Tactd, ARunOfAnAutomaticLawIsReplayedWithoutThePlan) {
  ASSERT_EQ(setenv("XDG_CACHE_HOME", folder.c_str(), 1), 0);
  const std::string log = in_folder("auto.tactlog");
  // A fresh clone has no plan of its machine: the scene's accuracy file chooses.
  const Outcome unplanned = tactd(kLiver + " --set law=auto --free-run --ticks 3");
  EXPECT_EQ(unplanned.status, 0) << unplanned.output;
  EXPECT_TRUE(has(unplanned, "--set law=rhombus: no plan of this machine")) << unplanned.output;
  // Its figures are not of other tissue.
  const std::string stiffer = " --set law=auto --set elastic.youngs_modulus_Pa=6000";
  const Outcome unknown = tactd(kLiver + stiffer + " --free-run --ticks 3");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_TRUE(has(unknown, "run tact-lab plan " + kLiver)) << unknown.output;
  const auto scene = tact::model::scene::load_scene(kLiver, {"law=\"auto\""});
  ASSERT_TRUE(scene) << scene.error().message;
  tact::tests::write_plan({.sizes = {.law = "rhombus", .table_knots = 33},
                           .machine = tact::model::scene::machine_name(),
                           .scene_hash = scene->hash},
                          *tact::model::scene::plan_path(scene->hash));
  const Outcome run = tactd(kLiver + " --set law=auto --free-run --ticks 900 --record " + log);
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(has(run, "--set law=rhombus --set table_knots=33")) << run.output;
  std::filesystem::remove_all(in_folder("tact"));
  const Outcome replayed = tactd(kLiver + " --replay " + log);
  EXPECT_TRUE(has(replayed, "900 ticks computed again, 0 differ")) << replayed.output;
  const Outcome other = tactd(kLiver + " --set law=rhombus --replay " + log);
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(has(other, "with --set law=auto --set law=rhombus --set table_knots=33 or no --set"));
  unsetenv("XDG_CACHE_HOME");
}

TEST_F(Tactd, StrictRefusesAPCWithoutHardRealTime) {
  const Outcome outcome = tactd(kLiver + " --strict --ticks 10");
  if (tact::firmware::pc::is_realtime_kernel(tact::firmware::pc::PcFiles{})) {
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return;
  }
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(has(outcome, "PREEMPT_RT")) << outcome.output;
  const json report = report_of(kLiver + " --ticks 10");
  EXPECT_EQ(report.at("non_rt"), true);
  EXPECT_NEAR(report.at("force_limit_N").get<double>(), 2.0, 1e-12) << "a quarter of 8 N";
}

TEST_F(Tactd, ControlCEndsItCleanly) {
  StartedProgram tactd(
      "tactd", {kLiver, "--socket", in_folder("t.sock"), "--json", in_folder("report.json")});
  ASSERT_NE(loop_thread(tactd.process(), 200), "");
  EXPECT_EQ(tactd.interrupt(), 0);
  std::ifstream file(in_folder("report.json"));
  const json report = json::parse(file, nullptr, false);
  EXPECT_GT(report.at("ticks").get<int>(), 100);
  EXPECT_FALSE(std::filesystem::exists(in_folder("t.sock"))) << "cleans up after itself";
}

}  // namespace tact::tests::tactd_test
