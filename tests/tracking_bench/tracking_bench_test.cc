// SPDX-License-Identifier: Apache-2.0
// tact-tracking-bench: the figure's arm holds the tool on the scene's motion and on those that its
// two-bone formula cannot follow; bad input is reported in one line.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "host/figure/tool_arm.h"
#include "tests/support/mesh_files.h"

namespace tact::tracking_bench::tracking_bench_test {

const std::string kScenes = TACT_SOURCE_DIR "/model/scenes/";

/// The counters of the benchmarks that `filter` names.
std::map<std::string, nlohmann::json> counted(const std::string& filter) {
  const tests::TempDirectory temp;
  const tests::Ran ran = tests::run_apart(
      temp, "tact-tracking-bench",
      kScenes + "maintenance.toml --benchmark_format=json --benchmark_filter='" + filter + "'");
  EXPECT_EQ(ran.status, 0) << ran.err;
  const auto reported = nlohmann::json::parse(ran.out);
  std::map<std::string, nlohmann::json> out;
  for (const auto& row : reported["benchmarks"]) {
    const std::string name = row["name"];
    out[name.substr(0, name.find('/'))] = row;
  }
  return out;
}

TEST(TrackingBench, TheShoulderFirstTurnsHalfOfTheJointsOnTheScenesMotion) {
  const auto rows = counted("^scene");
  const auto &first = rows.at("scene_shoulder_first"), &whole = rows.at("scene_full_chain");
  EXPECT_EQ(first["joint_updates"], 3600) << "the formula alone, twice in each of 1800 frames";
  EXPECT_EQ(first["sweeps"], 0);
  EXPECT_LT(first["worst_error_mm"], 1e-6);
  EXPECT_GE(whole["joint_updates"], 2 * 3600);
  EXPECT_LT(whole["worst_error_mm"], 0.5);
  for (const auto& [name, row] : rows) EXPECT_EQ(row["missed"], 0) << name;
}

TEST(TrackingBench, CcdHoldsTheToolWhereTheFormulaAloneMissesIt) {
  const auto rows = counted("^far|^turned");
  for (const std::string motion : {"far", "turned"}) {
    const auto &alone = rows.at(motion + "_formula_alone"), &ccd = rows.at(motion + "_with_ccd");
    EXPECT_EQ(alone["sweeps"], 0);
    EXPECT_GT(alone["missed"], 200);
    EXPECT_GT(alone["worst_error_mm"], 20.0);
    EXPECT_GT(ccd["sweeps"], 200);
    EXPECT_EQ(ccd["missed"], 0);
    EXPECT_LE(ccd["worst_error_mm"], 1e3 * host::figure::kGripTolerance_m);
  }
}

TEST(TrackingBench, SceneWithoutMotionIsRefusedInOneLine) {
  for (const std::string& scene :
       {kScenes + "liver.toml", std::string("/nowhere.toml"), std::string()}) {
    const tests::TempDirectory temp;
    const tests::Ran ran = tests::run_apart(temp, "tact-tracking-bench", scene);
    EXPECT_EQ(ran.status, 2) << scene;
    EXPECT_EQ(ran.err.find("tact-tracking-bench: "), 0U) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
}

}  // namespace tact::tracking_bench::tracking_bench_test
