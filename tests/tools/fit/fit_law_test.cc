// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_law.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "model/indent/hex_sheet.h"
#include "model/units.h"

namespace tact::tools::fit::fit_law_test {

using model::scene::Scene;
using model::operator""_mm;

const std::string kLiver = std::string(TACT_SOURCE_DIR) + "/model/scenes/liver.toml";

FitData press_and_pull() {
  FitData data;
  data.sites.push_back({.name = "a",
                        .samples = {{.depth_m = -8_mm, .force_N = -0.4},
                                    {.depth_m = -4_mm, .force_N = -0.2},
                                    {.depth_m = 20_mm, .force_N = 0.6}}});
  return data;
}

Scene liver() {
  auto scene = model::scene::load_scene(kLiver, {});
  EXPECT_TRUE(scene) << scene.error().message;
  return *scene;
}

TEST(FitLaw, BoundsAreRangesThatTheSceneAccepts) {
  const Scene scene = liver();
  std::set<std::string> seen;
  for (const FitLaw& law : fit_laws_of(scene, press_and_pull())) {
    for (const FitParameter& p : law.parameters) {
      const std::string key = p.section + "." + p.key;
      EXPECT_LT(0.0, p.low) << key;  // its logarithm is searched
      EXPECT_LT(p.low, p.high) << key;
      if (p.section == "pull" || !seen.insert(key).second) continue;  // may not be in the scene
      for (const double value : {p.low, p.high}) {
        const auto read = model::scene::load_scene(kLiver, {fmt::format("{}={:.9f}", key, value)});
        EXPECT_TRUE(read) << read.error().message;
      }
    }
  }
  EXPECT_GE(seen.size(), 12U);
}

TEST(FitLaw, EveryStartHasOneRatioForEachParameter) {
  for (const FitLaw& law : fit_laws_of(liver(), press_and_pull())) {
    EXPECT_FALSE(law.starts.empty()) << law.name;
    for (const std::vector<double>& start : law.starts)
      EXPECT_EQ(start.size(), law.parameters.size()) << law.name;
  }
}

TEST(FitLaw, EveryParameterIsWhereItsKeySays) {
  // Written through the parameter or read from the file, the scene holds the same number.
  Scene scene = liver();
  for (const FitLaw& law : fit_laws_of(scene, press_and_pull())) {
    for (const FitParameter& p : law.parameters) {
      if (p.section == "pull") continue;
      const double value = std::sqrt(p.low * p.high);
      auto read =
          model::scene::load_scene(kLiver, {fmt::format("{}.{}={:.17g}", p.section, p.key, value)});
      ASSERT_TRUE(read) << read.error().message;
      EXPECT_DOUBLE_EQ(p.in(*read), value) << p.section << "." << p.key;
    }
  }
}

TEST(FitLaw, ReachesWhereTheDataGoes) {
  Scene scene = liver();
  scene.pull.reset();
  reach(scene, press_and_pull());
  EXPECT_GE(0.95 * scene.laws.of<model::indent::HexSheetParameters>().working_depth_m,
            20_mm);  // what its table reaches
  EXPECT_GE(0.95 * scene.compliance.working_depth_m, 20_mm);
  ASSERT_TRUE(scene.pull);
  EXPECT_NEAR(scene.pull->stiffness_N_per_m, 50.0, 1e-9);  // 0.4 N at 8 mm
  EXPECT_DOUBLE_EQ(scene.pull->limit_m, 8_mm);
}

TEST(FitLaw, PullIsFittedOnlyWhereTheDataPulls) {
  FitData press = press_and_pull();
  press.sites[0].samples.erase(press.sites[0].samples.begin(), press.sites[0].samples.begin() + 2);
  for (const FitLaw& law : fit_laws_of(liver(), press))
    for (const FitParameter& p : law.parameters) EXPECT_NE(p.section, "pull") << law.name;
}

}  // namespace tact::tools::fit::fit_law_test
