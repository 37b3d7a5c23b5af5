// SPDX-License-Identifier: Apache-2.0
#include "model/indent/hunt_crossley.h"

#include <gtest/gtest.h>

#include "model/law/linear_pull.h"
#include "model/law/series_law.h"
#include "model/law/tabulated_law.h"
#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::indent::hunt_crossley_test {

constexpr HuntCrossleyParameters kSoft{
    .force_N = 0.5, .working_depth_m = 12_mm, .exponent = 1.5, .dissipation_s_per_m = 2.0};

HuntCrossley make(const HuntCrossleyParameters& p = kSoft) { return *make_hunt_crossley(p); }

double total_N(const law::Law& law, double depth_m, double speed_mps) {
  const double force_N = law.respond(depth_m).force_N;
  return force_N + law::resistance_N(law.damping_Ns_per_m(depth_m), speed_mps, force_N, false);
}

TEST(HuntCrossley, KeepsTheLawContractInsideAnyWrapper) {
  for (const double exponent : {1.0, 1.5, 3.0}) {
    HuntCrossleyParameters p = kSoft;
    p.exponent = exponent;
    const HuntCrossley law = make(p);
    tests::check_law_contract(law);
    tests::check_law_contract(
        *law::make_linear_pull(law, {.stiffness_N_per_m = 60, .limit_m = 10_mm}));
    for (const double compliance_m_per_N : {-0.003, 0.03}) {
      const law::SeriesLaw series = *law::make_series_law(law, compliance_m_per_N, law);
      tests::check_damping_takes_energy(series);
      tests::check_damping_takes_energy(*law::tabulate(series, 65));
    }
  }
}

TEST(HuntCrossley, HasConsistentDimensions) {
  tests::check_dimensions([](double m, double kg, double s) -> std::unique_ptr<law::Law> {
    return std::make_unique<HuntCrossley>(
        make({.force_N = kSoft.force_N * kg * m / (s * s),
              .working_depth_m = kSoft.working_depth_m * m,
              .exponent = kSoft.exponent,
              .dissipation_s_per_m = kSoft.dissipation_s_per_m * s / m}));
  });
}

TEST(HuntCrossley, MatchesNumbersWorkedByHand) {
  const HuntCrossley law = make();
  // x = 1/4: F = 0.5 / 8 N, U = F d / 2.5, K = 1.5 F / d, b = 2 F
  EXPECT_NEAR(law.respond(3_mm).force_N, 0.0625, 1e-15);
  EXPECT_NEAR(law.respond(3_mm).energy_J, 7.5e-5, 1e-15);
  EXPECT_NEAR(law.respond(3_mm).stiffness_N_per_m, 31.25, 1e-12);
  EXPECT_NEAR(total_N(law, 3_mm, 0.1), 0.0625 * 1.2, 1e-15);
  EXPECT_NEAR(total_N(law, 3_mm, -0.1), 0.0625 * 0.8, 1e-15);
  EXPECT_NEAR(total_N(law, 20_mm, 0.1), 0.6, 1e-15) << "beyond the range it stays";
}

TEST(HuntCrossley, LetsGoInsteadOfStickingAndBeginsContactWithoutAJump) {
  const HuntCrossley law = make();
  EXPECT_EQ(total_N(law, 3_mm, -0.6), 0.0) << "faster than 1 / lambda";
  EXPECT_LT(total_N(law, 1e-6, 0.5), 1e-5);
  // Held tissue may be pulled by its own damping.
  EXPECT_NEAR(law::resistance_N(0.125, -0.6, 0.0625, true), -0.075, 1e-15);
}

TEST(HuntCrossley, OrganInSeriesTakesItsShareOfTheSpeed) {
  const HuntCrossley law = make();
  const double compliance_m_per_N = 0.03;
  const law::SeriesLaw series = *law::make_series_law(law, compliance_m_per_N, law);
  // SL-4 at an indentation of 3 mm
  const double share = 1.0 / (1.0 + compliance_m_per_N * 31.25),
               depth_m = 3_mm + compliance_m_per_N * 0.0625;
  EXPECT_NEAR(series.damping_Ns_per_m(depth_m), 0.125 * share * share, 1e-12);
  EXPECT_NEAR(law::tabulate(series, 65)->damping_Ns_per_m(depth_m), 0.125 * share * share, 1e-4);
}

TEST(HuntCrossley, RefusesNumbersWithoutMeaning) {
  for (double HuntCrossleyParameters::* number :
       {&HuntCrossleyParameters::force_N, &HuntCrossleyParameters::working_depth_m,
        &HuntCrossleyParameters::exponent, &HuntCrossleyParameters::dissipation_s_per_m})
    for (const double value : {-1.0, std::nan("")}) {
      HuntCrossleyParameters bad = kSoft;
      bad.*number = value;
      EXPECT_FALSE(make_hunt_crossley(bad));
    }
}

}  // namespace tact::model::indent::hunt_crossley_test
