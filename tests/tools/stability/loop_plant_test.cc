// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/loop/loop_plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tact::tools::stability::loop_plant_test {

TEST(LoopPlant, FallsAsAFreeMassDoes) {
  LoopPlant plant({.mass_kg = 2.0});
  plant.place(0.1);
  plant.move(3.0, 0.5);
  EXPECT_NEAR(plant.position_m(), 0.1 + 0.5 * 1.5 * 0.25, 1e-12);  // x + a t^2 / 2
  EXPECT_NEAR(plant.velocity_mps(), 0.75, 1e-12);
}

TEST(LoopPlant, SwingsAsAnOscillatorDoesForAThousandPeriods) {
  LoopPlant plant({.mass_kg = 0.3, .stiffness_N_per_m = 1500.0});
  plant.place(1e-3);
  const double omega = std::sqrt(1500.0 / 0.3), time_s = 1e-3;
  for (int i = 1; i <= 100'000; ++i) plant.move(0.0, time_s);
  EXPECT_NEAR(plant.position_m(), 1e-3 * std::cos(omega * 100.0), 1e-12);
}

TEST(LoopPlant, DampsAsTheTextbookSays) {
  const double m = 0.3, b = 5.0, k = 1500.0, f = 0.7, t = 0.02;
  LoopPlant plant({.mass_kg = m, .damping_Ns_per_m = b, .stiffness_N_per_m = k});
  plant.move(f, t);
  const double sigma = b / (2 * m), w = std::sqrt(k / m - sigma * sigma);
  const double y =
      f / k * (1 - std::exp(-sigma * t) * (std::cos(w * t) + sigma / w * std::sin(w * t)));
  EXPECT_NEAR(plant.position_m(), y, 1e-14);
}

TEST(LoopPlant, DoesNotCareHowAMoveIsCut) {
  const PlantParameters parameters{
      .mass_kg = 0.2, .damping_Ns_per_m = 8.0, .stiffness_N_per_m = 900.0, .friction_N = 0.05};
  LoopPlant once(parameters), often(parameters);
  once.place(2e-3);
  often.place(2e-3);
  once.move(0.1, 0.1);
  for (int i = 0; i < 370; ++i) often.move(0.1, 0.1 / 370.0);
  EXPECT_NEAR(once.position_m(), often.position_m(), 1e-12);
}

TEST(LoopPlant, FrictionTakesFourCTimesAmplitudePerSwingAndThenHolds) {
  const double k = 1000.0, c = 0.1;
  LoopPlant plant({.mass_kg = 0.25, .stiffness_N_per_m = k, .friction_N = c});
  plant.place(1e-3);
  // each half swing ends 2 c / k nearer: 1 mm, -0.8 mm, 0.6 mm ...
  const double half_s = std::numbers::pi * std::sqrt(0.25 / k);
  plant.move(0.0, half_s);
  EXPECT_NEAR(plant.position_m(), -0.8e-3, 1e-9);
  plant.move(0.0, half_s);
  EXPECT_NEAR(plant.position_m(), 0.6e-3, 1e-9);
  plant.move(0.0, 10.0 * half_s);
  plant.move(0.0, half_s);
  EXPECT_TRUE(plant.is_stuck());
  EXPECT_EQ(plant.velocity_mps(), 0.0);
  EXPECT_LE(std::abs(k * plant.position_m()), c);
}

TEST(LoopPlant, FrictionHoldsUntilTheForceIsLarger) {
  LoopPlant plant({.mass_kg = 0.25, .friction_N = 0.1});
  plant.move(0.1, 1.0);
  EXPECT_TRUE(plant.is_stuck());
  EXPECT_EQ(plant.position_m(), 0.0);
  plant.move(-0.11, 1.0);
  EXPECT_FALSE(plant.is_stuck());
  EXPECT_NEAR(plant.position_m(), -0.5 * 0.01 / 0.25, 1e-12);
}

}  // namespace tact::tools::stability::loop_plant_test
