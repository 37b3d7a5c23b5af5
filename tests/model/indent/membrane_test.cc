// SPDX-License-Identifier: Apache-2.0
#include "model/indent/membrane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "model/law/series_law.h"
#include "model/law/tabulated_law.h"
#include "model/units.h"
#include "tests/model/indent/rigid_ball.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::indent::membrane_test {

constexpr double kTip_m = 4_mm;
// The tip of the liver: E 5 kPa, nu 0.45, R 4 mm.
constexpr MembraneParameters kSoft{.tension_N_per_m = 1.709,
                                   .foundation_Pa_per_m = 8.99e5,
                                   .softening_depth_m = 2.853_mm,
                                   .softening_exponent = 1.169,
                                   .working_depth_m = 12_mm};

Membrane make(const MembraneParameters& p = kSoft) { return *make_membrane(p, kTip_m); }

TEST(Membrane, KeepsTheLawContractAloneTabulatedAndOnAnOrgan) {
  const Membrane law = make();
  tests::check_law_contract(law);
  tests::check_law_contract(*law::tabulate(law, 65));
  tests::check_law_contract(*law::make_series_law(law, 0.03, law));
}

TEST(Membrane, HasConsistentDimensions) {
  tests::check_dimensions([](double m, double kg, double s) -> std::unique_ptr<law::Law> {
    return std::make_unique<Membrane>(
        *make_membrane({.tension_N_per_m = kSoft.tension_N_per_m * kg / (s * s),
                        .foundation_Pa_per_m = kSoft.foundation_Pa_per_m * kg / (m * m * s * s),
                        .softening_depth_m = kSoft.softening_depth_m * m,
                        .softening_exponent = kSoft.softening_exponent,
                        .working_depth_m = kSoft.working_depth_m * m},
                       kTip_m * m));
  });
}

/// On a linear foundation w = w(a) K_0(r / l) / K_0(a / l), l = sqrt(T / k): in closed form.
TEST(Membrane, IsTheBesselSolutionOnALinearFoundation) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int n = 0; n < 20; ++n) {
    MembraneParameters p = kSoft;
    p.softening_exponent = 0.0;
    p.tension_N_per_m = n == 0 ? 1e4 : std::pow(10.0, 2.0 * unit(rng) - 1.0);  // a soft, wide one
    p.foundation_Pa_per_m = n == 0 ? 1e6 : std::pow(10.0, 5.0 + 2.0 * unit(rng));
    const Membrane law = make(p);
    const double length_m = std::sqrt(p.tension_N_per_m / p.foundation_Pa_per_m);
    for (double a = 0.2_mm; a < 6_mm; a += 0.7_mm) {
      const double edge_m = a / kTip_m * length_m * std::cyl_bessel_k(0.0, a / length_m) /
                            std::cyl_bessel_k(1.0, a / length_m);
      const double depth_m = edge_m + 0.5 * a * a / kTip_m;
      if (depth_m < 0.2_mm || depth_m > 12_mm) continue;
      const double force_N =
          2.0 * std::numbers::pi *
          (0.5 * kTip_m * p.foundation_Pa_per_m * (depth_m * depth_m - edge_m * edge_m) +
           p.tension_N_per_m * a * a / kTip_m);
      EXPECT_NEAR(law.respond(depth_m).force_N / force_N, 1.0, 1e-3) << n << " a " << a;
    }
  }
}

TEST(Membrane, ABallIsFollowedWithinOneAndAHalfPercent) {
  tests::check_follows_ball(make(), 0.015);
}

TEST(Membrane, ItsForceIsInProportionToTensionAndFoundation) {
  MembraneParameters stiff = kSoft;
  stiff.tension_N_per_m *= 3.0;
  stiff.foundation_Pa_per_m *= 3.0;
  const Membrane soft = make(), three = make(stiff);
  for (const double d : {0.1_mm, 1_mm, 11_mm, 20_mm})
    EXPECT_NEAR(three.respond(d).force_N, 3.0 * soft.respond(d).force_N,
                1e-9 * three.respond(d).force_N);
}

TEST(Membrane, RefusesWhatHasNoMeaning) {
  const auto refused = [](auto change) {
    MembraneParameters p = kSoft;
    change(p);
    return !make_membrane(p, kTip_m);
  };
  EXPECT_TRUE(refused([](auto& p) { p.tension_N_per_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& p) { p.foundation_Pa_per_m = std::nan(""); }));
  EXPECT_TRUE(refused([](auto& p) { p.softening_depth_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& p) { p.softening_exponent = 2.5; }));
  EXPECT_FALSE(make_membrane(kSoft, 0.0));
}

}  // namespace tact::model::indent::membrane_test
