// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/scene/scene.h"

namespace tact::model::scene::law_numbers_test {

using Overrides = std::vector<std::string>;

Result<Scene> load(std::string_view name, const Overrides& overrides) {
  return load_scene(fmt::format("{}/model/scenes/{}.toml", TACT_SOURCE_DIR, name), overrides);
}

std::vector<reader::SceneNumber> numbers_of(std::string_view name, const Overrides& overrides) {
  const auto scene = load(name, overrides);
  EXPECT_TRUE(scene) << scene.error().message;
  const auto numbers = law_numbers(*scene, overrides);
  EXPECT_TRUE(numbers);
  return *numbers;
}

TEST(LawNumbers, AreThoseOfTheLawThatIsFelt) {
  for (const auto& [law, count] : {std::pair{"rhombus", 7u}, {"disc_stack", 10u}}) {
    const auto numbers = numbers_of("liver", {fmt::format("law={}", law)});
    EXPECT_EQ(numbers.size(), count);
    for (const reader::SceneNumber& number : numbers)
      EXPECT_TRUE(number.key.starts_with(fmt::format("{}.", law))) << number.key;
  }
}

TEST(LawNumbers, HaveTheValueOfTheRunWithUnitAndRange) {
  const auto numbers = numbers_of("liver", {"rhombus.normal_stiffness_N_per_m=2.5"});
  const auto found =
      std::ranges::find(numbers, "rhombus.normal_stiffness_N_per_m", &reader::SceneNumber::key);
  ASSERT_NE(found, numbers.end());
  EXPECT_EQ(found->value, 2.5);
  EXPECT_EQ(found->unit, "N/m");
  EXPECT_EQ(found->low, 0.01);
  EXPECT_EQ(found->high, 1e5);
  EXPECT_FALSE(found->is_whole);
  EXPECT_FALSE(found->meaning.empty());
}

TEST(LawNumbers, NothingBeyondTheToldRangeIsTaken) {
  for (const char* name : {"liver", "heart", "skin", "gum"}) {
    for (const reader::SceneNumber& number : numbers_of(name, {})) {
      const double beyond = number.is_whole ? number.high + 1.0 : number.high * 1.001;
      EXPECT_FALSE(load(name, {fmt::format("{}={}", number.key, beyond)})) << number.key;
    }
  }
}

/// The page of tools/run names a scene, and tools/run takes the file of that name.
TEST(LawNumbers, OfAShippedSceneTheNameIsThatOfItsFile) {
  for (const char* name : {"liver", "liver_twist", "heart", "skin", "gum", "maintenance"})
    EXPECT_EQ(load(name, {})->name, name);
}

}  // namespace tact::model::scene::law_numbers_test
