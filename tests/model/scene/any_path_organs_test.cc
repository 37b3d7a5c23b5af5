// SPDX-License-Identifier: Apache-2.0
// Random paths of a tool through every shipped organ, under one elastic law: contact_rules.h holds.
#include <gtest/gtest.h>

#include <string>

#include "model/scene/scene.h"
#include "tests/support/path_run.h"
#include "tests/support/sentence.h"

namespace tact::model::scene::any_path_organs_test {

class AnyPathOrgan : public ::testing::TestWithParam<const char*> {};

TEST_P(AnyPathOrgan, KeepsTheRulesOfContact) {
  auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/" + std::string(GetParam()) + ".toml", {});
  ASSERT_EQ(tests::sentence_of(scene), "");
  const tests::PathCounts counts = tests::run_random_paths(GetParam(), std::move(scene->organ_mesh),
                                                           tests::is_long() ? 4'000'000 : 100'000);
  RecordProperty("counts", counts.summary());
  EXPECT_TRUE(counts.broken.empty()) << counts.summary() << "\n" << counts.first;
  EXPECT_GT(counts.pauses, 5);
}

INSTANTIATE_TEST_SUITE_P(Shipped, AnyPathOrgan,
                         ::testing::Values("liver", "heart", "skin", "gum", "maintenance"));

}  // namespace tact::model::scene::any_path_organs_test
