// SPDX-License-Identifier: Apache-2.0
// tact-tick-bench: its path makes contact, every pass computes the same forces, and bad input is
// reported in one line.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/mesh_files.h"

namespace tact::tick_bench::tick_bench_test {

const std::string kScenes = TACT_SOURCE_DIR "/model/scenes/";

TEST(TickBench, MostTicksOfTheShippedLiverAreInContact) {
  const tests::TempDirectory temp;
  const tests::Ran ran = tests::run_apart(
      temp, "tact-tick-bench",
      kScenes + "liver.toml --benchmark_format=json --benchmark_filter='hot|cold_caches|spheres'");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto rows = nlohmann::json::parse(ran.out)["benchmarks"];
  ASSERT_EQ(rows.size(), 3u);
  const auto &hot = rows[0], &cold = rows[1], &one = rows[2];
  for (const auto& row : rows) {
    EXPECT_GT(row["ticks"], 5000) << row["name"];
    EXPECT_GT(row["work_J"], 1e-3) << "a hand that presses works" << row["name"];
    EXPECT_GT(row["median_us"], 0.0);
    EXPECT_LE(row["median_us"], row["p999_us"]);
    EXPECT_LE(row["p999_us"], row["longest_us"]);
  }
  EXPECT_EQ(hot["work_J"], cold["work_J"]) << "a pass leaves nothing behind";
  EXPECT_LT(one["work_J"], hot["work_J"]) << "one of two jaws";
}

TEST(TickBench, InvalidSceneIsRefusedInOneLine) {
  for (const std::string& scene :
       {std::string("/nowhere.toml"), std::string(), kScenes + "liver.toml no_key=1"}) {
    const tests::TempDirectory temp;
    const tests::Ran ran = tests::run_apart(temp, "tact-tick-bench", scene);
    EXPECT_EQ(ran.status, 2) << scene;
    EXPECT_EQ(ran.err.find("tact-tick-bench: "), 0U) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
}

}  // namespace tact::tick_bench::tick_bench_test
