// SPDX-License-Identifier: Apache-2.0
// What tactd refuses before the loop starts: a law that is too stiff for the device.
#include "firmware/admission/stiffness_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "model/indent/hunt_crossley.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::admission::stiffness_check_test {

hal::DeviceInfo device_with(double damping_Ns_per_m) {
  hal::DeviceInfo device{.name = {}, .grip = hal::GripKind::kNone};
  device.at_tool = model::DeviceAtTool{.damping_Ns_per_m = damping_Ns_per_m, .delay_s = 0.0005};
  device.damping_key = "device.sim.joint_damping_Nms_per_rad";
  return device;
}

bool has(const model::Error& error, const std::string& part) {
  return error.message.find(part) != std::string::npos;
}

TEST(StiffnessCheck, RefusesStiffnessBeyondTheDeviceLimitAndNamesTheKey) {
  model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  // One sphere, 100 N/m along the surface: K < b / (T/2 + t_d) = 1000 b.
  const auto fits = check_renderable(scene, *tissue, device_with(0.101));
  ASSERT_TRUE(fits) << fits.error().message;
  EXPECT_NEAR(fits->needed_N_per_m, 100.0, 1e-9);
  EXPECT_NEAR(fits->limit_N_per_m, 101.0, 1e-9);
  const auto refused = check_renderable(scene, *tissue, device_with(0.099));
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error().message,
      "plate.toml: contact.sliding_stiffness_N_per_m is too stiff: 100 N/m on 1 sphere is 100 "
      "N/m, this device is stable to 99 N/m at 1000 Hz; a device with more damping shows more "
      "(device.sim.joint_damping_Nms_per_rad says what this one has), device.kind = \"sim-ideal\" "
      "shows it as no real one can; write contact.sliding_stiffness_N_per_m = 99 or less, or "
      "rate_Hz "
      "= 1100");
  // What it says to write is taken.
  scene.rate_Hz = 1100.0;
  EXPECT_TRUE(check_renderable(scene, *tissue, device_with(0.099)));
  scene.rate_Hz = 1000.0;
  scene.tool.spheres.push_back({{}, 0.004});  // two spheres push at once
  const auto two = check_renderable(scene, *tissue, device_with(0.101));
  ASSERT_FALSE(two);
  EXPECT_TRUE(has(two.error(), "100 N/m on 2 spheres is 200 N/m")) << two.error().message;
  EXPECT_TRUE(has(two.error(), "write contact.sliding_stiffness_N_per_m = 50.5 or less"))
      << two.error().message;
}

// Of a real device it is measured: raising the number would make no hand safer.
TEST(StiffnessCheck, NeverAsksForALargerNumberOfTheDevicesDamping) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  hal::DeviceInfo device = device_with(0.05);
  device.damping_key = "device.falcon.joint_damping_Nms_per_rad";
  const auto refused = check_renderable(scene, *tissue, device);
  ASSERT_FALSE(refused);
  EXPECT_FALSE(has(refused.error(), "raise device.")) << refused.error().message;
  EXPECT_TRUE(
      has(refused.error(), "device.falcon.joint_damping_Nms_per_rad says what this one has"))
      << refused.error().message;
}

TEST(StiffnessCheck, NamesTheKeyWhereTheTissueIsTooStiffTangentially) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.contact.sliding_stiffness_N_per_m = 0.0;  // the tissue's own
  scene.elastic = {.youngs_modulus_Pa = 1e5, .poisson_ratio = 0.45};
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, device_with(0.6));
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "the tissue, held and pulled along its surface, is too stiff"))
      << refused.error().message;
  EXPECT_TRUE(has(refused.error(), "write contact.sliding_stiffness_N_per_m = 600 or less"))
      << refused.error().message;
}

TEST(StiffnessCheck, NamesThePullWhereItIsTheStifferOne) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.contact.sliding_stiffness_N_per_m = 1.0;
  scene.pull = {.stiffness_N_per_m = 4000.0, .limit_m = 0.01};
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, device_with(0.05));
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "write pull.stiffness_N_per_m = 50 or less"))
      << refused.error().message;
}

TEST(StiffnessCheck, EndsInTheNumbersToWriteWhereTheLawIsTooStiff) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.contact.sliding_stiffness_N_per_m = 1.0;
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  EXPECT_GT(tissue->law().stiffness_N_per_m(), 50.0);
  hal::DeviceInfo device = device_with(0.05);
  device.damping_key.clear();
  const auto refused = check_renderable(scene, *tissue, device);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "law rhombus is too stiff")) << refused.error().message;
  const std::string& text = refused.error().message;
  double normal_N_per_m = 0.0, tangential_N_per_m = 0.0, tear_N = 0.0;
  const std::size_t at = text.find("write rhombus.normal");
  ASSERT_NE(at, text.npos) << text;
  ASSERT_EQ(std::sscanf(text.c_str() + at,
                        "write rhombus.normal_stiffness_N_per_m = %lf and "
                        "rhombus.tangential_stiffness_N_per_m = %lf and contact.tear_force_N = "
                        "%lf or less",
                        &normal_N_per_m, &tangential_N_per_m, &tear_N),
            3)
      << text;
  auto& chain = scene.laws.of<model::indent::RhombusParameters>().chain;
  EXPECT_NEAR(normal_N_per_m / chain.normal_stiffness_N_per_m,
              tangential_N_per_m / chain.tangential_stiffness_N_per_m, 1e-3);
  chain.normal_stiffness_N_per_m = normal_N_per_m;
  chain.tangential_stiffness_N_per_m = tangential_N_per_m;
  scene.contact.tear_force_N = tear_N;
  const auto softer = std::move(*model::scene::make_tissue(scene));
  const auto fits = check_renderable(scene, *softer, device);
  ASSERT_TRUE(fits) << fits.error().message;
  EXPECT_GT(fits->needed_N_per_m, 0.995 * fits->limit_N_per_m) << "and no softer than needed";
}

TEST(StiffnessCheck, NamesNoRateThatIsNotEnough) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  // K < b / (T/2 + t_d): below b = 100 N/m * 0.5 ms no rate helps.
  const auto refused = check_renderable(scene, *tissue, device_with(0.049));
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().message.ends_with("= 49 or less")) << refused.error().message;
}

TEST(StiffnessCheck, RefusesADeviceThatDoesNotReportItsDamping) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused =
      check_renderable(scene, *tissue, {.name = "mute", .grip = hal::GripKind::kNone});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "device mute does not report its damping at the tool: fill DeviceInfo::at_tool");
}

TEST(StiffnessCheck, RefusesADampingThatLeavesTheDeviceTooLittle) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.law = "hunt_crossley";
  scene.contact.sliding_stiffness_N_per_m = 50.0;
  scene.tool.spheres.push_back({{}, 0.004});
  // 2 x 50 N/m need 0.1 of 0.2 N s/m, and the law takes 2 x 0.5 N x lambda
  auto& law = scene.laws.of<model::indent::HuntCrossleyParameters>();
  law = {.force_N = 0.5, .working_depth_m = 0.02, .exponent = 1.0};
  for (const double dissipation_s_per_m : {0.0, 0.09}) {
    law.dissipation_s_per_m = dissipation_s_per_m;
    const auto tissue = std::move(*model::scene::make_tissue(scene));
    const auto fits = check_renderable(scene, *tissue, device_with(0.2));
    ASSERT_TRUE(fits) << fits.error().message;
    EXPECT_NEAR(fits->limit_N_per_m, 200.0 - 950.0 * dissipation_s_per_m, 1e-6) << "0.95 of d_w";
  }
  law.dissipation_s_per_m = 0.12;
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, device_with(0.2));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "plate.toml: law hunt_crossley damps too much: 0.057 N s/m on 2 spheres, where this "
            "device has 0.2 N s/m of its own and 100 N/m to show at 1000 Hz; write "
            "hunt_crossley.dissipation_s_per_m = 0.1052 or less");
}

TEST(PressCheck, ReportsTheLargestSlopeAndWhereTheSameEachTime) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const model::scene::TissueLaw& law = tissue->law();
  const auto check = check_presses(scene, *tissue, device_with(0.3), 300.0);
  ASSERT_TRUE(check) << check.error().message;
  // One sphere on a plate: the steepest press of the law.
  double steepest_N_per_m = 0.0;
  for (double d_m = 0.0; d_m < law.range().press_m; d_m += 1e-5)
    steepest_N_per_m = std::max(steepest_N_per_m, law.curve()->respond(d_m).stiffness_N_per_m);
  EXPECT_NEAR(check->slope_N_per_m, steepest_N_per_m, 0.01 * steepest_N_per_m);
  EXPECT_EQ(check->presses, 33U) << "the hand's, 16 square and 16 upright";
  EXPECT_TRUE(check->place.starts_with("vertex ")) << check->place;
  EXPECT_EQ(check->note, "");
  const auto again = check_presses(scene, *tissue, device_with(0.3), 300.0);
  EXPECT_EQ(again->slope_N_per_m, check->slope_N_per_m);
  EXPECT_EQ(again->place, check->place);
}

model::scene::PressResult pressed(std::uint32_t vertex, double slope_N_per_m, double change_N) {
  model::scene::PressResult r;
  r.place = {vertex, model::scene::PressWay::kUpright};
  r.state = model::scene::PressState::kPressed;
  r.slope_N_per_m = {slope_N_per_m, 0.0032};
  r.change_N = {change_N, 0.0073};
  return r;
}

TEST(PressCheck, RefusesASlopeAboveTheLimitWhereTheHandPresses) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  model::scene::PressSweep sweep{.settings = {.limit_N_per_m = 300.0}, .results = {}};
  sweep.results = {pressed(7, 299.0, 0.001), pressed(9, 200.0, 0.001)};
  EXPECT_TRUE(check_sweep(scene, tissue->law(), device_with(0.3), sweep));
  sweep.results = {pressed(7, 301.0, 0.001), pressed(9, 200.0, 0.001)};
  const auto refused = check_sweep(scene, tissue->law(), device_with(0.3), sweep);
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error().message,
      "plate.toml: the whole tool is too stiff where the hand presses: 301 N/m at vertex 7, "
      "upright, 3.2 mm deep; this device is stable to 300 N/m at 1000 Hz; a device with more "
      "damping "
      "shows more (device.sim.joint_damping_Nms_per_rad says what this one has), device.kind = "
      "\"sim-ideal\" shows it as no real one can; write rhombus.normal_stiffness_N_per_m = 149.5 "
      "and "
      "rhombus.tangential_stiffness_N_per_m = 179.4 or less, or rate_Hz = 1100");
  // A force that is no number is not stable.
  sweep.results.front().slope_N_per_m.value = std::nan("");
  EXPECT_FALSE(check_sweep(scene, tissue->law(), device_with(0.3), sweep));
}

// A place where the force changes all at once, or too stiff a one that the hand does not press.
TEST(PressCheck, NamesABadPlaceWithTheRemedyAndDoesNotRefuseIt) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  model::scene::PressSweep sweep{.settings = {.limit_N_per_m = 300.0}, .results = {}};
  sweep.results = {pressed(7, 200.0, 0.001), pressed(3080, 200.0, 0.262), pressed(5, 310.0, 0.001)};
  const auto check = check_sweep(scene, tissue->law(), device_with(0.3), sweep);
  ASSERT_TRUE(check) << check.error().message;
  EXPECT_EQ(check->slope_N_per_m, 310.0);
  EXPECT_EQ(check->place, "vertex 5, upright");
  EXPECT_EQ(
      check->note,
      "plate.toml: 2 of 3 presses of the whole tool are not sound, the worst at vertex 3080, "
      "upright: the force changes by 0.262 N in 0.02 mm at 7.30 mm (allowed: 0.006 N); smooth "
      "or refine the organ's mesh there (tact-mesh), or keep the tool from it; tact-lab sweep "
      "tries every vertex");
}

}  // namespace tact::firmware::admission::stiffness_check_test
