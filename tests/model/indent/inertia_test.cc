// SPDX-License-Identifier: Apache-2.0
#include "model/indent/inertia.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/units.h"

namespace tact::model::indent::inertia_test {

// as liver.toml has it
constexpr ElasticTip kLiver{.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45, .radius_m = 4_mm};
constexpr double kNoticed = 0.07;

TEST(Inertia, IsSevenPercentOfTheForceAtTheSpeedsOfTheReadme) {
  EXPECT_NEAR(inertia_speed_mps(kLiver, 1_mm, kNoticed), 0.037, 0.0005);
  EXPECT_NEAR(inertia_speed_mps(kLiver, 5_mm, kNoticed), 0.109, 0.0005);
  EXPECT_NEAR(inertia_speed_mps(kLiver, 10_mm, kNoticed), 0.216, 0.0005);
}

TEST(Inertia, ShallowInertiaSpeedIsThatOfAHertzContact) {
  // IN-2: 8 / 10.2 q sqrt(G / rho) sqrt(d / R), for any nu
  for (const double nu : {0.0, 0.3, 0.5}) {
    const ElasticTip tip{.youngs_modulus_Pa = 2.0 * (1.0 + nu) * kTissueDensity_kg_per_m3,
                         .poisson_ratio = nu,
                         .radius_m = 1_mm};  // waves of 1 m/s
    EXPECT_NEAR(inertia_speed_mps(tip, 1e-5, 1.0), 8.0 / 10.2 * 0.1, 2e-4) << nu;
  }
}

TEST(Inertia, AFreeLobeSwaysAtTheRatesOfTheReadme) {
  const auto sway_Hz = [](double length_m) {  // IN-3
    constexpr double kThick_m = 40_mm;
    return 0.1615 * kThick_m / (length_m * length_m) *
           std::sqrt(kLiver.youngs_modulus_Pa / kTissueDensity_kg_per_m3);
  };
  EXPECT_NEAR(sway_Hz(63_mm), 3.5, 0.1);
  EXPECT_NEAR(sway_Hz(46_mm), 6.6, 0.1);
}

}  // namespace tact::model::indent::inertia_test
