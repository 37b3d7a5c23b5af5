// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/scene/laws.h"
#include "model/scene/scene.h"

namespace tact::model::scene::law_numbers_test {

using Overrides = std::vector<std::string>;

Result<Scene> load(std::string_view name, const Overrides& overrides) {
  return load_scene(fmt::format("{}/model/scenes/{}.toml", TACT_SOURCE_DIR, name), overrides);
}

/// Its law, and the numbers of that.
struct LawInUse {
  Scene scene;
  std::vector<Parameter> numbers = parameters_of(*find_law(scene.law), scene).all;

  std::string key(const Parameter& number) const {
    return fmt::format("{}.{}", scene.law, number.key);
  }
};

LawInUse law_in_use(std::string_view name, const Overrides& overrides) {
  auto scene = load(name, overrides);
  EXPECT_TRUE(scene) << scene.error().message;
  return {std::move(*scene)};
}

TEST(LawNumbers, AreThoseOfTheLawInUse) {
  for (const auto& [law, count] : {std::pair{"rhombus", 7u}, {"disc_stack", 10u}}) {
    const LawInUse used = law_in_use("liver", {fmt::format("law={}", law)});
    EXPECT_EQ(used.scene.law, law);
    EXPECT_EQ(used.numbers.size(), count);
  }
}

TEST(LawNumbers, HaveTheValueOfTheRunWithItsRange) {
  const LawInUse used = law_in_use("liver", {"rhombus.normal_stiffness_N_per_m=2.5"});
  const auto found = std::ranges::find(used.numbers, "normal_stiffness_N_per_m", &Parameter::key);
  ASSERT_NE(found, used.numbers.end());
  EXPECT_EQ(found->value(), 2.5);
  EXPECT_EQ(found->range.low, 0.01);
  EXPECT_EQ(found->range.high, 1e5);
  EXPECT_EQ(found->count, nullptr);
  EXPECT_FALSE(found->meaning.empty());
}

TEST(LawNumbers, NothingBeyondTheStatedRangeIsTaken) {
  for (const char* name : {"liver", "heart", "skin", "gum"}) {
    const LawInUse used = law_in_use(name, {});
    for (const Parameter& number : used.numbers) {
      const double beyond = number.count ? number.range.high + 1.0 : number.range.high * 1.001;
      EXPECT_FALSE(load(name, {fmt::format("{}={}", used.key(number), beyond)})) << number.key;
    }
  }
}

/// The page of tools/run names a scene, and tools/run takes the file of that name.
TEST(LawNumbers, ShippedSceneHasTheNameOfItsFile) {
  for (const char* name :
       {"liver", "liver_twist", "liver_source", "grasper", "heart", "skin", "gum", "maintenance"})
    EXPECT_EQ(load(name, {})->name, name);
}

}  // namespace tact::model::scene::law_numbers_test
