// SPDX-License-Identifier: Apache-2.0
// A scene whose law is a measured table.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/scene/tissue_law.h"
#include "tests/model/scene/shipped_law.h"
#include "tests/support/mesh_files.h"
#include "tests/support/message.h"

namespace tact::model::scene::measured_table_test {

using shipped_law::made;
using shipped_law::Overrides;
using shipped_law::refusal;
using shipped_law::shipped;

TEST(MeasuredTable, AMeasuredTableIsInSeriesWithTheOrganAsAnyTip) {
  const Overrides table{"law=table", "table.data=\"press.csv\""};
  const auto law = made(shipped("liver", table));
  EXPECT_EQ(law->title(), "measured table, 49 rows, on an organ that bends");
  for (const double depth_m : {0.0005, 0.002, 0.006, 0.0115}) {
    const double hertz_N = 4.0 / 3.0 * 6269.6 * std::sqrt(0.004) * std::pow(depth_m, 1.5);
    EXPECT_NEAR(law->curve()->respond(depth_m).force_N / hertz_N, 1.0, 0.02) << depth_m;
  }
  EXPECT_EQ(refusal(shipped("liver", {"law=table", "table.force_ratio=2"}), "table"),
            TACT_SOURCE_DIR
            "/model/scenes/liver.toml: table.data names no file; write data = "
            "\"press.csv\"");
}

TEST(MeasuredTable, AnErrorInAMeasuredTableNamesFileAndLine) {
  const tests::TempDirectory folder;
  std::string hash, falling = "# mm\ndepth_mm,force_mN\n";
  for (int i = 0; i < 15; ++i) falling += fmt::format("{},{}\n", i, i < 9 ? 10 * i : 5 * i);
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"depth_mm,force_N\n0,0\n1,1\n2,x\n", "press.csv:4: force_N: \"x\" is no number"},
           {"depth_mm,force_N\n0,0\n1,0,5\n", "press.csv:3: 3 values, but line 1 names 2"},
           {"depth;force\n0;0\n", "press.csv:1: no column depth_mm or depth_m"},
           {"depth_m,force_mN\n0,0\n1,1\n2,2\n3,3\n4,4\n", "press.csv:3: the depth is 1 m"},
           {falling, "press.csv:12: the force falls"},
           {"depth_mm,force_mN\n0,0\n1,10\n2,20\n3,30\n4,40\n", ""}}) {
    const std::string path = folder.write("press.csv", text);
    const Scene scene = shipped("liver", {"law=table", "table.data=\"" + path + "\""});
    EXPECT_NE(scene.hash, hash) << "other bytes, another hash";
    hash = scene.hash;
    EXPECT_NE(refusal(scene, "table").find(words), std::string::npos) << refusal(scene, "table");
    EXPECT_EQ(refusal(scene, "table").empty(), words.empty()) << refusal(scene, "table");
  }
}

}  // namespace tact::model::scene::measured_table_test
