// SPDX-License-Identifier: Apache-2.0
// Every map on its coarse extent: each finding is a theorem of the method it measures.
#include "tools/stability/sweep/run_maps.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/files.h"

namespace tact::tools::stability::run_maps_test {

namespace fs = std::filesystem;
using tests::content;

class RunMaps : public testing::Test {
 protected:
  RunMaps() : folder_(testing::TempDir() + "tact-maps-" + std::to_string(getpid())) {
    fs::remove_all(folder_);
  }
  ~RunMaps() override { fs::remove_all(folder_); }
  StabilityOptions options(const std::string& only, const std::string& below = "whole") const {
    fs::create_directories(folder_ + "/" + below);
    return {
        .out = folder_ + "/" + below, .only = only, .extent = Extent::kQuick, .draw_plots = false};
  }
  void check_findings(const std::string& only) {
    const auto run = run_maps(options(only));
    ASSERT_FALSE(run.error) << run.error->message;
    ASSERT_EQ(run.reports.size(), 1u);
    EXPECT_GE(run.reports.front().findings.size(), 2u);
    for (const Finding& f : run.reports.front().findings) EXPECT_TRUE(f.holds) << f.message;
  }
  std::string folder_;
};

TEST_F(RunMaps, IntegratorsGrowWhereTheirMatricesSay) { check_findings("integrators"); }
TEST_F(RunMaps, LawsStayFiniteAndTheGateBoundedBeyondTheirRange) { check_findings("law_limits"); }
TEST_F(RunMaps, LawsEndWhereTheirParametersSay) { check_findings("law_lines"); }
TEST_F(RunMaps, WallsAreStableUpToTheClosedFormula) { check_findings("loop"); }
TEST_F(RunMaps, LawsAreStableUpToTheirTangent) { check_findings("loop_laws"); }
TEST_F(RunMaps, TheWholeControllerAgreesInKind) { check_findings("loop_delta"); }
TEST_F(RunMaps, LostAndLateTicksCostWhatTheMeanSquareSays) { check_findings("ticks"); }
TEST_F(RunMaps, ABurstOfLossesFadesAndLatches) { check_findings("loss"); }

TEST_F(RunMaps, ASecondRunGivesTheSameBytes) {
  for (const char* map : {"ticks", "law_limits"}) {
    ASSERT_FALSE(run_maps(options(map, "first")).error);
    ASSERT_FALSE(run_maps(options(map, "second")).error);
    for (const char* end : {".csv", ".json"})
      EXPECT_EQ(content(folder_ + "/first/" + map + end),
                content(folder_ + "/second/" + map + end));
  }
}

}  // namespace tact::tools::stability::run_maps_test
