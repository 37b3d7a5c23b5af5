// SPDX-License-Identifier: Apache-2.0
// Random paths of a tool through every shipped organ, under one elastic law: contact_rules.h holds.
#include <gtest/gtest.h>

#include <string>

#include "model/scene/scene.h"
#include "tests/support/extent.h"
#include "tests/support/message.h"
#include "tests/support/path_run.h"

namespace tact::model::scene::any_path_organs_test {

class AnyPathOrgan : public ::testing::TestWithParam<const char*> {};

TEST_P(AnyPathOrgan, KeepsTheRulesOfContact) {
  auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/" + std::string(GetParam()) + ".toml", {});
  ASSERT_EQ(tests::message_of(scene), "");
  const tests::PathCounts counts = tests::run_random_paths(GetParam(), std::move(scene->organ_mesh),
                                                           tests::share_of(100'000, 4'000'000));
  RecordProperty("counts", counts.summary());
  EXPECT_TRUE(counts.broken.empty()) << counts.summary() << "\n" << counts.first;
  EXPECT_GT(counts.pauses, tests::share_of(5, 5));
  EXPECT_LT(counts.forks, 2 + counts.pauses / 50);
  EXPECT_LT(static_cast<double>(counts.unsettled), 0.03 * static_cast<double>(counts.ticks));
}

INSTANTIATE_TEST_SUITE_P(Shipped, AnyPathOrgan,
                         ::testing::Values("liver", "heart", "skin", "gum", "maintenance"));

// Paths of earlier long runs, each of which broke a rule.
void expect_kept(const std::string& name, const std::vector<std::uint32_t>& seeds) {
  auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", {});
  ASSERT_EQ(tests::message_of(scene), "");
  const tests::PathCounts counts = tests::run_paths_of(name, std::move(scene->organ_mesh), seeds);
  EXPECT_TRUE(counts.broken.empty()) << name << ": " << counts.summary() << "\n" << counts.first;
}

TEST(AnyPathOrganFound, ThroughAHoleOfTheHeartTheToolComesInside) {
  expect_kept("heart", {79, 81, 89, 93, 111, 113, 137, 142, 219, 249, 329, 508, 576, 596});
}

TEST(AnyPathOrganFound, AForceThatWouldJumpFollows) {
  expect_kept("heart", {47, 227, 267, 413, 587, 741});
  expect_kept("maintenance", {39, 49, 101, 837});
}

TEST(AnyPathOrganFound, TurningTheForceCreatesNoEnergy) {
  expect_kept("gum", {437, 449, 597});
  expect_kept("maintenance", {71, 91, 269, 853});
}

TEST(AnyPathOrganFound, AContactThatLetsGoIsGoneIn100ms) {
  expect_kept("skin", {596, 662});
  expect_kept("gum", {213, 526, 667, 860});
  expect_kept("maintenance", {646, 715, 860});
}

TEST(AnyPathOrganFound, APauseBesideAForkIsNoPauseOfItsOwn) { expect_kept("maintenance", {145}); }

}  // namespace tact::model::scene::any_path_organs_test
