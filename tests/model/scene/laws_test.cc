// SPDX-License-Identifier: Apache-2.0
// The rows of the laws: what tactd and the tools read of them must hold of every law.
#include "model/scene/laws.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "model/scene/scene.h"

namespace tact::model::scene::laws_test {

const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

/// Inside of its range, and none of the defaults.
double example_of(const Parameter& p) {
  const double inside = p.range.low + 0.3 * (p.range.high - p.range.low);
  return p.count ? std::floor(inside) : inside;
}

TEST(Laws, EveryRowMakesALawOfItsOwnName) {
  std::set<std::string_view> names{kAutoLaw};
  for (const LawRow& row : all_laws()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_EQ(find_law(row.name), &row);
    EXPECT_FALSE(row.meaning.empty()) << row.name;
    EXPECT_NE(row.curve == nullptr, row.build == nullptr) << row.name;
  }
  EXPECT_EQ(find_law("none"), nullptr);
  EXPECT_EQ(find_law(kAutoLaw), nullptr);
}

TEST(Laws, EveryKeyIsReadFromItsSection) {
  for (const LawRow& row : all_laws()) {
    Scene any;
    std::vector<std::string> overrides{fmt::format("law={}", row.name)};
    if (parameters_of(row, any).find("layer_thickness_m").number != nullptr)
      overrides.emplace_back("compliance.map=\"\"");  // one of both
    for (const Parameter& p : parameters_of(row, any).all)
      overrides.push_back(fmt::format("{}.{}={}", row.name, p.key, example_of(p)));
    auto scene = load_scene(kLiver, overrides);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->law, row.name);
    for (const Parameter& p : parameters_of(row, *scene).all)
      EXPECT_EQ(p.value(), example_of(p)) << row.name << "." << p.key;
  }
}

TEST(Laws, KeysOfFitAndChartAreInTheSectionOfTheLaw) {
  Scene any;
  for (const LawRow& row : all_laws()) {
    const ParameterList list = parameters_of(row, any);
    for (const std::string_view key : row.fit_keys)
      EXPECT_NE(list.find(key).number, nullptr) << row.name << "." << key;
    for (const auto& start : row.fit_starts) EXPECT_EQ(start.size(), row.fit_keys.size());
    EXPECT_TRUE(row.size_key.empty() || list.find(row.size_key).count) << row.name;
    EXPECT_EQ(row.sizes.empty(), row.quick_sizes.empty()) << row.name;
  }
}

}  // namespace tact::model::scene::laws_test
