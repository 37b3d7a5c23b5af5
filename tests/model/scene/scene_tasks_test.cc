// SPDX-License-Identifier: Apache-2.0
// The tasks of a scene: read as written, or refused with the value to write.
#include "model/scene/scene_tasks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace tact::model::scene::scene_tasks_test {

const std::string kCover = TACT_SOURCE_DIR "/model/scenes/maintenance.toml";

/// Of the cover with this one task in place of its own.
Result<Scene> with_task(const std::string& keys) {
  return load_scene(kCover, {"task=[{text=\"press\", " + keys + "}]"});
}

std::string complaint(const std::string& keys) {
  const Result<Scene> scene = with_task(keys);
  return scene ? "" : scene.error().message;
}

const std::string kPlace = "place_m=[0.026, 0.0, 0.0061], radius_m=0.004, ";
const std::string kForce = "ends_by=\"force\", force_min_N=0.3, force_max_N=2.0";

TEST(SceneTasks, AShippedSceneHasThree) {
  const Result<Scene> scene = load_scene(kCover, {});
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->tasks.size(), 3u);
  const Task& first = scene->tasks[0];
  EXPECT_FALSE(first.text.empty());
  EXPECT_FALSE(first.by_grip);
  EXPECT_EQ(first.force_min_N, 0.3);
  EXPECT_EQ(first.force_max_N, 2.0);
  EXPECT_EQ(first.hold_s, 0.5);
  EXPECT_EQ(scene->tasks[1].hold_s, 0.0);
  EXPECT_EQ(scene->tasks[2].place_m, (Vec3{0.0, -0.02, 0.0}));
}

TEST(SceneTasks, AGripEndsOneAsWell) {
  const Result<Scene> scene =
      with_task(kPlace + "ends_by=\"grip\", grip_min_ratio=0.8, grip_max_ratio=1.0");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_TRUE(scene->tasks[0].by_grip);
  EXPECT_EQ(scene->tasks[0].grip_min_ratio, 0.8);
}

/// What a message must have.
struct Refusal {
  std::string keys;
  std::vector<std::string> parts;
};

TEST(SceneTasks, RefusesWhatCannotEnd) {
  const Refusal kRefusals[] = {
      {kPlace + "ends_by=\"wish\"", {"ends_by", "wish", "force", "grip"}},
      {kPlace + "ends_by=\"force\", force_min_N=0.3", {"force_max_N"}},
      {kPlace + "ends_by=\"force\", force_min_N=3.0, force_max_N=2.0",
       {"force_min_N = 3 must be below force_max_N = 2"}},
      {kPlace + "ends_by=\"force\", force_min_N=8.0, force_max_N=9.0", {"limits.force_N = 8"}},
      {kPlace + "ends_by=\"grip\", grip_min_ratio=0.5, grip_max_ratio=1.5",
       {"grip_max_ratio", "0 .. 1"}},
      {"place_m=[0.026, 0.0, 0.0061], radius_m=0.0, " + kForce, {"radius_m", "0.001 .. 0.1 m"}},
      {"place_m=[0.0, 0.0, 0.3], radius_m=0.004, " + kForce,
       {"from the organ's nearest vertex", "write place_m = [", "that vertex"}},
      {kPlace + kForce + ", seconds=3", {"seconds"}},
      {kPlace + kForce + ", hold_s=-1.0", {"hold_s", "0 .. 60 s"}},
  };
  for (const auto& [keys, parts] : kRefusals) {
    const std::string message = complaint(keys);
    for (const std::string& part : parts)
      EXPECT_NE(message.find(part), message.npos) << part << " in: " << message;
  }
}

TEST(SceneTasks, RefusesALongTextAndTooManyTasks) {
  const std::string one = "{text=\"t\", " + kPlace + kForce + "},";
  std::string many = "task=[";
  for (std::size_t i = 0; i <= kMaxTasks; ++i) many += one;
  const Result<Scene> crowd = load_scene(kCover, {many + "]"});
  ASSERT_FALSE(crowd);
  EXPECT_NE(crowd.error().message.find("task"), std::string::npos) << crowd.error().message;
  const std::string text(kMaxTaskText + 1, 'x');
  const Result<Scene> novel =
      load_scene(kCover, {"task=[{text=\"" + text + "\", " + kPlace + kForce + "}]"});
  ASSERT_FALSE(novel);
  EXPECT_NE(novel.error().message.find("121 bytes; write at most 120"), std::string::npos)
      << novel.error().message;
}

}  // namespace tact::model::scene::scene_tasks_test
