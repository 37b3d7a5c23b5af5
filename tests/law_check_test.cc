// What tactd refuses before the loop starts: too stiff for the device, too slow for the tick.
#include "firmware/law_check.h"

#include <gtest/gtest.h>

#include "tests/test_scene.h"

namespace tact::firmware {
namespace {

hal::DeviceInfo device_with(double damping_Ns_per_m) {
  hal::DeviceInfo device;
  device.at_tool = {.damping_Ns_per_m = damping_Ns_per_m, .delay_s = 0.0005};
  return device;
}

TEST(LawCheck, RefusesAStiffnessBeyondTheDevicesLimitAndSaysWhatToChange) {
  model::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::make_tissue(scene));
  // One sphere, 100 N/m along the surface: K < b / (T/2 + t_d) = 1000 b.
  EXPECT_GE(tissue->law().stiffness_N_per_m(), 50.0);
  EXPECT_LE(tissue->law().stiffness_N_per_m(), 100.0);
  EXPECT_FALSE(check_renderable(scene, *tissue, device_with(0.101)));
  const auto refused = check_renderable(scene, *tissue, device_with(0.099));
  ASSERT_TRUE(refused);
  EXPECT_NE(refused->sentence.find("plate.toml: 1 spheres of up to 100 N/m"), std::string::npos);
  EXPECT_NE(refused->sentence.find("make the tissue softer"), std::string::npos);
  scene.tool.spheres.push_back({{}, 0.004});  // two spheres push at once
  EXPECT_TRUE(check_renderable(scene, *tissue, device_with(0.101)));
}

TEST(LawCheck, RefusesALawThatCannotKeepItsBudget) {
  model::Scene scene = tests::make_plate_scene();
  EXPECT_FALSE(check_budget(scene)) << "no budget, nothing to say";
  scene.tolerance = {.force_error_ratio = 0.07, .shape_error_ratio = 0.2, .tick_budget_us = 1e6};
  EXPECT_FALSE(check_budget(scene));
  scene.tolerance->tick_budget_us = 1e-4;
  const auto refused = check_budget(scene);
  ASSERT_TRUE(refused);
  EXPECT_NE(refused->sentence.find("tolerance.tick_budget_us is 0.0001"), std::string::npos);
  EXPECT_NE(refused->sentence.find("tact-plan"), std::string::npos);
}

TEST(LawCheck, MeasuringLeavesTheFeltTissueAlone) {
  model::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::make_tissue(scene));
  const auto ask = [&] {
    return tissue->law().site_law().respond({.place = {0, {1, 0, 0}}, .depth_m = 1e-3});
  };
  const double before_N = ask().law.force_N;
  scene.tolerance = {.force_error_ratio = 0.07, .shape_error_ratio = 0.2, .tick_budget_us = 1e6};
  EXPECT_FALSE(check_law(scene, *tissue, device_with(10.0)));
  EXPECT_EQ(ask().law.force_N, before_N);
}

}  // namespace
}  // namespace tact::firmware
