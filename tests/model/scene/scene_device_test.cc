// SPDX-License-Identifier: Apache-2.0
// What a scene says of its device is taken by that device, or refused.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace tact::model::scene::scene_device_test {

const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

using Overrides = std::vector<std::string>;

bool is_refused_for(const Overrides& overrides, const std::string& words) {
  const Result<Scene> scene = load_scene(kLiver, overrides);
  return !scene && scene.error().sentence.find(words) != std::string::npos;
}

TEST(SceneDevice, RefusesALimitThatItsDrivesWouldNotKeep) {
  const std::string moteus = "device.kind=can-moteus";
  const std::string current = "device.can.max_current_A=10",
                    velocity = "device.can.max_velocity_turns_per_s=20";
  EXPECT_TRUE(is_refused_for({moteus, current, velocity}, "max_current_A is for an ODrive"));
  EXPECT_TRUE(load_scene(kLiver, {"device.kind=can-odrive", current, velocity}));
  EXPECT_TRUE(load_scene(kLiver, {current, velocity})) << "a simulated device has no drives";
  for (const std::string key : {"rated_torque_Nm=0.3", "command_at_sync=true"}) {
    EXPECT_TRUE(is_refused_for({moteus, "device.can." + key}, "is for a CiA 402 drive"));
    EXPECT_TRUE(load_scene(kLiver, {"device.kind=can-cia402", "device.can." + key}));
  }
}

}  // namespace tact::model::scene::scene_device_test
