// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "firmware/admission/refusals.h"

namespace tact::firmware::admission::thermal_check_test {

// A PHANTOM's: the scene says 20 N for long, the device bears 1.4.
model::Limits limits(double continuous_N, double thermal_time_s) {
  model::Limits limits;
  limits.force_N = 8.5;
  limits.slew_N_per_s = 1000.0;
  limits.ramp_s = 0.5;
  limits.continuous_force_N = continuous_N;
  limits.thermal_time_s = thermal_time_s;
  return limits;
}

TEST(ThermalCheck, LowerContinuousForceNeedsALongerThermalTime) {
  model::scene::Scene scene;
  scene.path = "mine.toml";
  scene.rate_Hz = 1000.0;
  EXPECT_FALSE(check_thermal(scene, limits(20.0, 0.1)));
  EXPECT_FALSE(check_thermal(scene, limits(1.4, 10.0)));
  const auto error = check_thermal(scene, limits(1.4, 0.1));
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("mine.toml: limits.thermal_time_s = 0.1 is too short"),
            std::string::npos);
  EXPECT_NE(error->message.find("bears 1.4 N for long"), std::string::npos);
  // steepness 71.7: (8.5 / 1.4) 8.5 / 2 of it by 983 N/s
  EXPECT_NE(error->message.find("allowed: 1.89 or more"), std::string::npos) << error->message;
  EXPECT_FALSE(check_thermal(scene, limits(1.4, 1.89)));
}

}  // namespace tact::firmware::admission::thermal_check_test
