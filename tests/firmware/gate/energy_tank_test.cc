// SPDX-License-Identifier: Apache-2.0
#include "firmware/gate/energy_tank.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware/gate/number_classes.h"

namespace tact::firmware::gate::energy_tank_test {

using tests::numbers::all_classes;
using tests::numbers::for_each_vector;
using tests::numbers::kInfinity;

EnergyTank placed_tank() {
  EnergyTank tank({.budget_J = 0.1,
                   .recovery_W = 0.01,
                   .speed_mps = 1.0,
                   .turn_radps = 10.0,
                   .force_limit_N = 8.0,
                   .lever_m = 0.0,
                   .slew_N_per_s = 1000.0,
                   .period_s = 0.001});
  tank.observe({}, true, 1.0, {});
  return tank;
}

TEST(EnergyTank, ATankCountsForceTimesWay) {
  EnergyTank tank = placed_tank();
  model::Tool tool;
  tool.position_m.x = 0.002;
  tank.observe(tool, true, 1.0, {{5, 0, 0}, {}});
  EXPECT_NEAR(tank.given_energy_J(), 0.01 - 1e-5, 1e-12) << "5 N * 2 mm, less 10 mW for 1 ms";
  tool.position_m.x = 0.0;
  tank.observe(tool, true, 1.0, {{5, 0, 0}, {}});
  EXPECT_NEAR(tank.given_energy_J(), -1e-5, 1e-12) << "taken back; what came back stays";
}

TEST(EnergyTank, AMissedSampleIsCountedWithTheMeanForce) {
  EnergyTank tank = placed_tank();
  model::Tool tool;
  tank.observe(tool, false, 1.0, {{4, 0, 0}, {}});
  EXPECT_LT(tank.allowed_N(), 8.0 + 1e-9);
  tool.position_m.x = 0.002;
  tank.observe(tool, true, 1.0, {{2, 0, 0}, {}});
  EXPECT_NEAR(tank.given_energy_J(), 0.006 - 2e-5, 1e-12) << "3 N * 2 mm";
}

TEST(EnergyTank, TheBrakeKnowsWhatAForceGivesWhileItFalls) {
  EnergyTank tank = placed_tank();
  model::Tool tool;
  tool.position_m.x = 0.016;
  tank.observe(tool, true, 1.0, {{5, 0, 0}, {}});  // 20 mJ are left, and 10 uJ came back
  // 1 m/s (m^2 / (2 * 1000 N/s) + m * 1 ms) = 20.01 mJ at m = 5.40 N
  EXPECT_NEAR(tank.allowed_N(), 5.40, 0.01);
}

TEST(EnergyTank, ATankForgetsWhatItTookBeyondTwoBudgets) {
  EnergyTank tank = placed_tank();
  model::Tool tool;
  tool.position_m.x = -1.0;
  tank.observe(tool, true, 1.0, {{8, 0, 0}, {}});
  EXPECT_EQ(tank.given_energy_J(), -0.1);
}

TEST(EnergyTank, AStepOfAnyClassLeavesATankThatIsSoundOrOverdrawn) {
  for_each_vector(all_classes(), [](const Vec3& to_m) {
    EnergyTank tank = placed_tank();
    model::Tool tool;
    tool.position_m = to_m;
    tank.observe(tool, true, 1.0, {{5, -1, 2}, {}});
    const double allowed_N = tank.allowed_N();
    ASSERT_GE(allowed_N, 0.0);
    ASSERT_LE(allowed_N, 8.0);
    if (!tank.is_overdrawn()) ASSERT_LE(tank.given_energy_J(), 0.1 + 1e-9);
    if (!(std::abs(to_m.x) < kInfinity)) ASSERT_TRUE(tank.is_overdrawn() || to_m.x < 0.0);
  });
}

}  // namespace tact::firmware::gate::energy_tank_test
