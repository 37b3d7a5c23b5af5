// SPDX-License-Identifier: Apache-2.0
// law = "auto" of every shipped scene on a machine that has no plan.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "model/scene/accuracy_file.h"
#include "model/scene/plan_file.h"

namespace tact::model::scene::fresh_clone_test {

TEST(Plan, FreshCloneAutoLawIsNoWorseThanTheShippedLaw) {
  ASSERT_EQ(setenv("XDG_CACHE_HOME", (testing::TempDir() + "tact_no_plan").c_str(), 1), 0);
  for (const std::string name : {"liver", "heart", "skin", "gum", "maintenance"}) {
    const std::string path = std::string(TACT_SOURCE_DIR) + "/model/scenes/" + name + ".toml";
    const auto shipped = load_scene(path, {});
    const auto automatic = load_scene(path, {"law=auto"});
    ASSERT_TRUE(shipped && automatic) << name;
    const auto plan = find_auto_law(*automatic, {"law=auto"});
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_TRUE(plan->machine.empty()) << name;
    const auto accuracy = read_accuracy(*shipped);
    ASSERT_TRUE(accuracy) << accuracy.error().message;
    EXPECT_LE(plan->force_error_ratio, worst_error_ratio(*accuracy)) << name;
    // A file that says "auto" itself, as one of tact-lab new-scene.
    const auto nearest = nearest_law(*automatic);
    ASSERT_TRUE(nearest) << name;
    EXPECT_LE(worst_error_ratio(*nearest), worst_error_ratio(*accuracy)) << name;
    EXPECT_EQ(nearest->law == "spring_patch", name == "gum") << nearest->law;
  }
  unsetenv("XDG_CACHE_HOME");
}

}  // namespace tact::model::scene::fresh_clone_test
