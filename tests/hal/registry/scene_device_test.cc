// SPDX-License-Identifier: Apache-2.0
// What a scene says of its device is taken by that device, or refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <vector>

#include "hal/can/can_settings.h"
#include "hal/falcon/falcon_device.h"
#include "hal/force_dimension/force_dimension_device.h"
#include "hal/phantom/phantom_device.h"
#include "hal/registry/open_device.h"
#include "tests/support/device_scene.h"
#include "tests/support/example_delta.h"

namespace tact::hal::registry::scene_device_test {

using model::Result;
using model::scene::Scene;
using tests::scene_on_real_devices;
using tests::without_line;
using Overrides = std::vector<std::string>;

Result<Scene> load(const std::string& text, const Overrides& overrides = {}) {
  const std::string path =
      testing::TempDir() + "scene_device_" + std::to_string(getpid()) + ".toml";
  std::ofstream(path) << text;
  return load_scene(path, overrides);
}

/// Empty where the scene is taken.
std::string why_refused(const std::string& text, const Overrides& overrides = {}) {
  const Result<Scene> scene = load(text, overrides);
  return scene ? "" : scene.error().message;
}

bool is_reported(const std::string& message, const std::string& words) {
  return message.find(words) != std::string::npos;
}

TEST(SceneDevice, TheSectionsOfRealDevicesHoldTheDefaultsAndFitAScene) {
  const Result<Scene> scene = load(scene_on_real_devices());
  ASSERT_TRUE(scene) << scene.error().message;
  const model::DeviceSettings fresh;
  EXPECT_EQ(scene->device.kind, "can-odrive");
  const auto& said = scene->device.of<can::DeltaSettings>();
  const auto simulated = tests::example_delta().of<can::DeltaSettings>();
  EXPECT_EQ(said.base_radius_m, simulated.base_radius_m);
  EXPECT_EQ(said.platform_radius_m, simulated.platform_radius_m);
  EXPECT_EQ(said.upper_arm_m, simulated.upper_arm_m);
  EXPECT_EQ(said.forearm_m, simulated.forearm_m);
  EXPECT_NEAR(said.theta_min_rad, simulated.theta_min_rad, 1e-4);
  EXPECT_NEAR(said.theta_max_rad, simulated.theta_max_rad, 1e-4);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(said.azimuth_rad[i], simulated.azimuth_rad[i], 1e-7);
  EXPECT_EQ(said.platform_kg, simulated.platform_kg);
  EXPECT_EQ(said.forearm_kg, simulated.forearm_kg);
  EXPECT_EQ(said.max_joint_torque_Nm, simulated.max_joint_torque_Nm);
  const auto& can = scene->device.of<can::CanSettings>();
  EXPECT_EQ(can.node, fresh.of<can::CanSettings>().node);
  EXPECT_EQ(can.homing, fresh.of<can::CanSettings>().homing);
  const auto& falcon = scene->device.of<falcon::FalconSettings>();
  EXPECT_EQ(falcon.gain_words_per_Nm, fresh.of<falcon::FalconSettings>().gain_words_per_Nm);
  using force_dimension::ForceDimensionSettings, phantom::PhantomSettings;
  EXPECT_EQ(scene->device.of<ForceDimensionSettings>().watchdog_s,
            fresh.of<ForceDimensionSettings>().watchdog_s);
  EXPECT_EQ(scene->device.of<PhantomSettings>().position_step_m,
            fresh.of<PhantomSettings>().position_step_m);
  EXPECT_FALSE(scene->device.of<LinesSettings>().wired());
}

TEST(SceneDevice, RefusesALimitThatItsDrivesWouldNotKeep) {
  const std::string can = scene_on_real_devices(), moteus = "device.kind=can-moteus";
  const std::string current = "device.can.max_current_A=10",
                    velocity = "device.can.max_velocity_turns_per_s=20";
  EXPECT_TRUE(
      is_reported(why_refused(can, {moteus, current, velocity}), "max_current_A is for an ODrive"));
  EXPECT_EQ(why_refused(can, {"device.kind=can-odrive", current, velocity}), "");
  EXPECT_EQ(why_refused(can, {"device.kind=falcon", current, velocity}), "") << "has no drives";
  for (const std::string key : {"rated_torque_Nm=0.3", "command_at_sync=true"}) {
    const std::string set = "device.can." + key;
    EXPECT_TRUE(is_reported(why_refused(can, {moteus, set}), "is for a CiA 402 drive"));
    EXPECT_EQ(why_refused(can, {"device.kind=can-cia402", set}), "");
  }
}

TEST(SceneDevice, ACustomDeltaHasNoDefaultLengthOrMass) {
  const std::string can = scene_on_real_devices();
  EXPECT_EQ(why_refused(can), "");
  for (const std::string key : {"base_radius_m",
                                "platform_radius_m",
                                "upper_arm_m",
                                "forearm_m",
                                "azimuth_rad",
                                "theta_min_rad",
                                "theta_max_rad",
                                "arm_kg",
                                "arm_com_m",
                                "arm_inertia_kgm2",
                                "rotor_inertia_kgm2",
                                "gear_ratio",
                                "forearm_kg",
                                "platform_kg",
                                "middle_m",
                                "workspace_radius_m",
                                "workspace_half_length_m",
                                "max_force_N",
                                "max_joint_torque_Nm",
                                "joint_friction_Nm",
                                "joint_damping_Nms_per_rad",
                                "counts_per_turn"})
    EXPECT_TRUE(is_reported(why_refused(without_line(can, key + " =")),
                            "device.delta." + key + " is missing"))
        << key;
  EXPECT_TRUE(is_reported(why_refused(without_line(can, "direction =")),
                          "device.can.direction is missing"));
  EXPECT_TRUE(
      is_reported(why_refused(without_line(can, "homing =")), "device.can.homing is missing"));
}

TEST(SceneDevice, EachHomingNeedsWhatSaysWhereTheArmsAre) {
  const std::string can = scene_on_real_devices(), absolute = "device.can.homing=absolute";
  EXPECT_TRUE(
      is_reported(why_refused(without_line(can, "home_rad =")), "device.can.home_rad is missing"));
  EXPECT_EQ(why_refused(without_line(can, "zero_turns =")), "");
  EXPECT_TRUE(is_reported(why_refused(without_line(can, "zero_turns ="), {absolute}),
                          "device.can.zero_turns is missing"));
  EXPECT_EQ(why_refused(without_line(can, "home_rad ="), {absolute}), "");
}

TEST(SceneDevice, ASceneOfTheSimulationSetToDrivesNeedsTheirSections) {
  const std::string liver = TACT_SOURCE_DIR "/model/scenes/liver.toml";
  const Result<Scene> scene = load_scene(liver, {"device.kind=can-odrive"});
  ASSERT_FALSE(scene);
  EXPECT_TRUE(is_reported(scene.error().message, "device.delta is missing"))
      << scene.error().message;
}

TEST(SceneDevice, IsReadWithTheKeysOfDevicesAlone) {
  const std::string liver = TACT_SOURCE_DIR "/model/scenes/liver.toml";
  const Overrides wrong{"device.sim.joint_friction_Nm=7", "device.colour=1"};
  EXPECT_FALSE(load_scene(liver, wrong));
  const Result<Scene> without = model::scene::load_scene(liver, wrong);
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_EQ(without->device.kind, "") << "so it opens none";
  EXPECT_FALSE(open_device(*without));
}

TEST(SceneDevice, OneValueAnArmIsThreeNumbersAndSaysWhichIsWrong) {
  const std::string can = scene_on_real_devices();
  EXPECT_TRUE(is_reported(why_refused(can, {"device.can.home_rad=[0.0, 9.0, 0.0]"}),
                          "device.can.home_rad 2 = 9 is out of range"));
  EXPECT_TRUE(is_reported(why_refused(can, {"device.can.home_rad=[0.0, 0.0]"}),
                          "has 2 elements, not three"));
  EXPECT_TRUE(is_reported(why_refused(can, {"device.can.node=[1, 2, 2.5]"}),
                          "three different whole numbers"));
  EXPECT_TRUE(is_reported(why_refused(can, {"device.can.direction=[1, 1, 0.5]"}),
                          "takes 1 or -1 for each arm"));
}

}  // namespace tact::hal::registry::scene_device_test
