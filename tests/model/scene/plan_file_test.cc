// SPDX-License-Identifier: Apache-2.0
// What tactd takes as the plan of a scene on this machine, and what it refuses.
#include "model/scene/plan_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/damage.h"
#include "tests/support/measured_files.h"
#include "tests/support/test_scene.h"

namespace tact::model::scene::plan_file_test {

using tests::plan_text;
using tests::write_plan;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class PlanFile : public testing::Test {
 protected:
  PlanFile() {
    scene_.described = {"compliance"};
    plan_ = {.sizes = {.law = "compliance", .table_knots = 33, .size = 9},
             .tick_p999_us = 0.25,
             .force_error_ratio = 0.0123,
             .shape_error_ratio = 0.05,
             .machine = machine_name(),
             .scene_hash = scene_.hash};
    std::filesystem::create_directories(folder_);
  }
  ~PlanFile() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text) const {
    const std::string path = folder_ + "/plan.toml";
    std::ofstream(path) << text;
    return path;
  }
  void expect_remedy(const Result<Plan>& read, const std::string& what) const {
    ASSERT_FALSE(read) << what;
    EXPECT_TRUE(has(read.error().message, what)) << read.error().message;
    EXPECT_TRUE(
        has(read.error().message,
            "run tact-lab plan plate.toml --set law=auto --set 'name=\"a b\"' --reference FILE, "
            "FILE from tact-lab reference plate.toml --out FILE"))
        << read.error().message;
  }

  const std::vector<std::string> kSet{"law=auto", "name=\"a b\""};
  const std::string folder_ = testing::TempDir() + "tact_plan_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name();
  Scene scene_ = tests::make_plate_scene();
  Plan plan_;
};

TEST_F(PlanFile, IsFoundAgainByTheSceneAndSetsItsLawAndSizes) {
  ASSERT_EQ(setenv("XDG_CACHE_HOME", folder_.c_str(), 1), 0);
  const auto path = plan_path(scene_.hash);
  ASSERT_TRUE(path);
  write_plan(plan_, *path);
  const auto read = find_plan(scene_, {});
  unsetenv("XDG_CACHE_HOME");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(plan_text(*read), plan_text(plan_));
  scene_ = sized(scene_, read->sizes);
  EXPECT_EQ(scene_.law, "compliance");
  EXPECT_EQ(scene_.table_knots, 33U);
  EXPECT_EQ(scene_.compliance.curves, 9U);
}

TEST_F(PlanFile, PlanOfAShippedSceneIsFoundForAnAutoOverride) {
  const std::string liver = std::string(TACT_SOURCE_DIR) + "/model/scenes/liver.toml";
  const auto planned = load_scene(liver, {"rate_Hz=2000"});
  const auto run = load_scene(liver, {"law=auto", "rate_Hz=2000"});
  const auto slower = load_scene(liver, {"law=auto"});
  ASSERT_TRUE(planned && run && slower);
  plan_.scene_hash = planned->hash;
  ASSERT_EQ(setenv("XDG_CACHE_HOME", folder_.c_str(), 1), 0);
  write_plan(plan_, *plan_path(planned->hash));
  const auto found = find_plan(*run, {"law=auto", "rate_Hz=2000"});
  const auto missing = find_plan(*slower, {"law=auto"});
  unsetenv("XDG_CACHE_HOME");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->sizes.law, "compliance");
  ASSERT_FALSE(missing) << "the plan of another rate";
  EXPECT_TRUE(has(missing.error().message, "run tact-lab plan " + liver + " --reference"))
      << missing.error().message;
}

TEST_F(PlanFile, RefusesWhatIsMissingDamagedOrStale) {
  expect_remedy(read_plan(folder_ + "/none.toml", scene_, kSet), "no plan for this scene");
  expect_remedy(read_plan(write("law = \"comp"), scene_, kSet), "damaged");
  expect_remedy(read_plan(write(io::sealed_text("law = \"glue\"\n")), scene_, kSet), "no law");
  expect_remedy(read_plan(write(io::sealed_text("law = \"auto\"\n")), scene_, kSet), "no law");
  for (const char* text :
       {"law = \"compliance\"\ncurves = -3\n", "law = \"rhombus\"\ncurves = -3\n",
        "law = \"rhombus\"\ntable_knots = 1000000\n"})
    expect_remedy(read_plan(write(io::sealed_text(text)), scene_, kSet), "out of range");
  expect_remedy(read_plan(write(io::sealed_text("law = \"rhombus\"\n")), scene_, kSet),
                "tick_p999_us is missing");
  Plan other = plan_;
  other.machine = "1 x another processor";
  expect_remedy(read_plan(write(plan_text(other)), scene_, kSet), "another machine");
  other = plan_;
  other.scene_hash = "fedcba9876543210";
  expect_remedy(read_plan(write(plan_text(other)), scene_, kSet), "another scene");
  other = plan_;
  other.sizes.law = "hex_sheet";
  expect_remedy(read_plan(write(plan_text(other)), scene_, kSet), "no law hex_sheet");
}

TEST_F(PlanFile, EveryDamageIsReported) {
  tests::expect_all_damage_is_reported(write(plan_text(plan_)), [&](const std::string& path) {
    const auto read = read_plan(path, scene_, kSet);
    return !read && has(read.error().message, "damaged, its sha256");
  });
}

}  // namespace tact::model::scene::plan_file_test
