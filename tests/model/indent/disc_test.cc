// SPDX-License-Identifier: Apache-2.0
#include "model/indent/disc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "model/units.h"

namespace tact::model::indent::disc_test {

// The printed example, with the modulus that gives its printed stiffness.
constexpr DiscDimensions kPrinted{.outer_diameter_m = 0.4_mm,
                                  .inner_diameter_m = 0.204_mm,
                                  .thickness_m = 22.5e-6,
                                  .free_height_m = 31.5e-6,
                                  .youngs_modulus_Pa = 2.06e11,
                                  .poisson_ratio = 0.3};

constexpr Disc kSoft{
    .outer_diameter_m = 10_mm, .stiffness_N_per_m = 500.0, .travel_m = 0.9_mm, .cone_ratio = 0.4};

TEST(Disc, MatchesTheWorkedExampleUnrounded) {
  // DS-12: alpha 0.686144, k 9.39503e4 N/m, k h0 0.845553 N, eta = 9 / 22.5
  const auto disc = make_disc(kPrinted);
  ASSERT_TRUE(disc);
  EXPECT_NEAR(disc_shape_factor(kPrinted.outer_diameter_m / kPrinted.inner_diameter_m), 0.686144,
              5e-7);
  EXPECT_NEAR(disc->stiffness_N_per_m, 9.39503e4, 0.5);
  EXPECT_NEAR(disc->flat_force_N(), 0.845553, 5e-7);
  EXPECT_NEAR(disc->cone_ratio, 0.4, 1e-12);
}

TEST(Disc, ShapeFactorHasNoSeamBetweenFormulaAndSeries) {
  const double below = disc_shape_factor(1.001 - 1e-12), above = disc_shape_factor(1.001 + 1e-12);
  EXPECT_NEAR(below / above, 1.0, 1e-8);
  // Thin rings: alpha = 6 w / pi to first order, w = ln C
  EXPECT_NEAR(disc_shape_factor(1.0 + 0x1p-30) / (6 * 0x1p-30 / std::numbers::pi), 1.0, 1e-8);
}

TEST(Disc, ForceIsTheSlopeOfEnergyAndReachesTheSameForceWhenFlat) {
  const double h0 = kSoft.travel_m, step_m = 1e-6 * h0;
  for (const DiscForm form : {DiscForm::kAlmenLaszlo, DiscForm::kLinear}) {
    for (double x = 0.05; x < 1.0; x += 0.1) {
      const auto ahead = respond(kSoft, form, x * h0 + step_m);
      const auto behind = respond(kSoft, form, x * h0 - step_m);
      const auto here = respond(kSoft, form, x * h0);
      EXPECT_NEAR((ahead.energy_J - behind.energy_J) / (2.0 * step_m), here.force_N, 1e-8);
      EXPECT_NEAR((ahead.force_N - behind.force_N) / (2.0 * step_m), here.stiffness_N_per_m, 1e-5);
    }
    EXPECT_NEAR(respond(kSoft, form, h0).force_N, 500.0 * 0.9e-3, 1e-15);
  }
}

TEST(Disc, FlatteningAndForceInvertEachOther) {
  for (const double cone : {0.0, 1e-7, 0.1, 0.4, 1.0, 1.414, std::numbers::sqrt2}) {
    Disc disc = kSoft;
    disc.cone_ratio = cone;
    for (const double x : {1e-12, 1e-6, 0.01, 0.3, 0.5, 0.7, 0.99}) {
      const double force_N = respond(disc, DiscForm::kAlmenLaszlo, x * disc.travel_m).force_N;
      const double back_m = flattening_at_m(disc, DiscForm::kAlmenLaszlo, force_N);
      EXPECT_NEAR(back_m / (x * disc.travel_m), 1.0, 1e-9) << "eta " << cone << ", x " << x;
    }
    EXPECT_NEAR(flattening_at_m(disc, DiscForm::kAlmenLaszlo, disc.flat_force_N()), disc.travel_m,
                1e-18);
  }
}

TEST(Disc, RefusesDimensionsWithoutMeaning) {
  const auto refused = [](auto change) {
    DiscDimensions p = kPrinted;
    change(p);
    return !make_disc(p);
  };
  EXPECT_TRUE(refused([](auto& p) { p.inner_diameter_m = p.outer_diameter_m; }));
  EXPECT_TRUE(refused([](auto& p) { p.inner_diameter_m = 0.0; }));
  DiscDimensions flat = kPrinted;
  flat.free_height_m = flat.thickness_m;
  EXPECT_NE(make_disc(flat).error().message.find("no cone"), std::string::npos);
  EXPECT_TRUE(refused([](auto& p) { p.thickness_m = -1.0; }));
  EXPECT_TRUE(refused([](auto& p) { p.youngs_modulus_Pa = std::nan(""); }));
  EXPECT_TRUE(refused([](auto& p) { p.poisson_ratio = 0.5; }));
  EXPECT_TRUE(refused([](auto& p) { p.poisson_ratio = -1.0; }));
}

}  // namespace tact::model::indent::disc_test
