// SPDX-License-Identifier: Apache-2.0
// What tactd refuses before the loop starts: a law that is too stiff for the device.
#include "firmware/admission/stiffness_check.h"

#include <gtest/gtest.h>

#include "tests/support/test_scene.h"

namespace tact::firmware::admission::stiffness_check_test {

hal::DeviceInfo device_with(double damping_Ns_per_m) {
  hal::DeviceInfo device;
  device.at_tool = model::DeviceAtTool{.damping_Ns_per_m = damping_Ns_per_m, .delay_s = 0.0005};
  device.damping_key = "device.sim.joint_damping_Nms_per_rad";
  return device;
}

bool has(const model::Error& error, const std::string& part) {
  return error.sentence.find(part) != std::string::npos;
}

TEST(StiffnessCheck, RefusesAStiffnessBeyondTheDevicesLimitAndSaysWhichKeyToChange) {
  model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  // One sphere, 100 N/m along the surface: K < b / (T/2 + t_d) = 1000 b.
  const auto fits = check_renderable(scene, *tissue, device_with(0.101));
  ASSERT_TRUE(fits) << fits.error().sentence;
  EXPECT_NEAR(fits->needed_N_per_m, 100.0, 1e-9);
  EXPECT_NEAR(fits->limit_N_per_m, 101.0, 1e-9);
  const auto refused = check_renderable(scene, *tissue, device_with(0.099));
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error().sentence,
      "plate.toml: contact.sliding_stiffness_N_per_m is too stiff: 100 N/m on 1 sphere is 100 "
      "N/m, this device is stable to 99 N/m at 1000 Hz; lower it to 99 N/m or less, raise "
      "rate_Hz, or take a device with more damping (device.sim.joint_damping_Nms_per_rad says what "
      "this one has)");
  scene.tool.spheres.push_back({{}, 0.004});  // two spheres push at once
  const auto two = check_renderable(scene, *tissue, device_with(0.101));
  ASSERT_FALSE(two);
  EXPECT_TRUE(has(two.error(), "100 N/m on 2 spheres is 200 N/m")) << two.error().sentence;
  EXPECT_TRUE(has(two.error(), "to 50.5 N/m or less")) << two.error().sentence;
}

// Of a real device it is measured: raising the number would make no hand safer.
TEST(StiffnessCheck, NeverAsksForALargerNumberOfTheDevicesDamping) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  hal::DeviceInfo device = device_with(0.05);
  device.damping_key = "device.falcon.joint_damping_Nms_per_rad";
  const auto refused = check_renderable(scene, *tissue, device);
  ASSERT_FALSE(refused);
  EXPECT_FALSE(has(refused.error(), "raise device.")) << refused.error().sentence;
  EXPECT_TRUE(
      has(refused.error(), "device.falcon.joint_damping_Nms_per_rad says what this one has"))
      << refused.error().sentence;
}

TEST(StiffnessCheck, NamesTheKeyToSetWhereTheTissueItselfIsTooStiffAlongItsSurface) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.contact.sliding_stiffness_N_per_m = 0.0;  // the tissue's own
  scene.elastic = {.youngs_modulus_Pa = 1e5, .poisson_ratio = 0.45};
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, device_with(0.6));
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "the tissue, held and pulled along its surface, is too stiff"))
      << refused.error().sentence;
  EXPECT_TRUE(has(refused.error(), "set contact.sliding_stiffness_N_per_m to 600 N/m or less"))
      << refused.error().sentence;
}

TEST(StiffnessCheck, NamesThePullWhereItIsTheStifferOne) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.contact.sliding_stiffness_N_per_m = 1.0;
  scene.pull = {.stiffness_N_per_m = 4000.0, .limit_m = 0.01};
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, device_with(0.05));
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "soften pull.stiffness_N_per_m to 50 N/m"))
      << refused.error().sentence;
}

TEST(StiffnessCheck, NamesTheLawWhereItIsTheStifferOne) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.contact.sliding_stiffness_N_per_m = 1.0;
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  EXPECT_GT(tissue->law().stiffness_N_per_m(), 50.0);
  hal::DeviceInfo device = device_with(0.05);
  device.damping_key.clear();
  const auto refused = check_renderable(scene, *tissue, device);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "law rhombus is too stiff")) << refused.error().sentence;
  EXPECT_TRUE(has(refused.error(), "soften [rhombus] to 50 N/m")) << refused.error().sentence;
  EXPECT_TRUE(refused.error().sentence.ends_with("or take a device with more damping"))
      << refused.error().sentence;
}

TEST(StiffnessCheck, RefusesADeviceThatDoesNotTellItsDamping) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, {.name = "mute"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().sentence,
            "device mute does not tell its damping at the tool: fill DeviceInfo::at_tool");
}

TEST(StiffnessCheck, RefusesADampingThatLeavesTheDeviceTooLittle) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.law = model::scene::LawKind::kHuntCrossley;
  scene.contact.sliding_stiffness_N_per_m = 50.0;
  scene.tool.spheres.push_back({{}, 0.004});
  // 2 x 50 N/m need 0.1 of 0.2 N s/m, and the law takes 2 x 0.5 N x lambda
  scene.hunt_crossley = {.force_N = 0.5, .working_depth_m = 0.02, .exponent = 1.0};
  for (const double dissipation_s_per_m : {0.0, 0.09}) {
    scene.hunt_crossley.dissipation_s_per_m = dissipation_s_per_m;
    const auto tissue = std::move(*model::scene::make_tissue(scene));
    const auto fits = check_renderable(scene, *tissue, device_with(0.2));
    ASSERT_TRUE(fits) << fits.error().sentence;
    EXPECT_NEAR(fits->limit_N_per_m, 200.0 - 950.0 * dissipation_s_per_m, 1e-6) << "0.95 of d_w";
  }
  scene.hunt_crossley.dissipation_s_per_m = 0.12;
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, device_with(0.2));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().sentence,
            "plate.toml: law hunt_crossley damps too much: 0.057 N s/m on 2 spheres, where this "
            "device has 0.2 N s/m of its own and 100 N/m to show at 1000 Hz; lower the damping of "
            "[hunt_crossley] to 0.05 N s/m or less");
}

}  // namespace tact::firmware::admission::stiffness_check_test
