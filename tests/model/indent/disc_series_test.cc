// SPDX-License-Identifier: Apache-2.0
#include "model/indent/disc_series.h"

#include <gtest/gtest.h>

#include <random>

#include "model/law/series_law.h"
#include "model/units.h"
#include "tests/model/indent/rigid_ball.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::indent::disc_series_test {

// The tip of the liver: E 5 kPa, nu 0.45, R 4 mm.
constexpr DiscSeriesParameters kSoft{.force_N = 0.50284,
                                     .working_depth_m = 12_mm,
                                     .exponent = 1.2858,
                                     .exponent_slope = -0.0735,
                                     .first_depth_m = 0.2_mm,
                                     .discs = 9};

DiscSeries make(const DiscSeriesParameters& p = kSoft) { return *make_disc_series(p); }

TEST(DiscSeries, KeepsTheLawContractAloneAndOnAnOrgan) {
  for (const std::size_t discs : {2u, 9u, 31u})
    for (const double exponent : {1.3, 1.5, 3.0}) {
      DiscSeriesParameters p = kSoft;
      p.discs = discs;
      p.exponent = exponent;
      const DiscSeries law = make(p);
      tests::check_law_contract(law);
      tests::check_law_contract(*law::make_series_law(law, 0.03, law));
    }
}

TEST(DiscSeries, HasConsistentDimensions) {
  tests::check_dimensions([](double m, double kg, double s) -> std::unique_ptr<law::Law> {
    DiscSeriesParameters p = kSoft;
    p.force_N *= kg * m / (s * s);
    p.working_depth_m *= m;
    p.first_depth_m *= m;
    return std::make_unique<DiscSeries>(make(p));
  });
}

TEST(DiscSeries, MatchesNumbersWorkedByHand) {
  // P = 1, 4 N at D = 1, 2 mm: K = 1000, 3000 N/m; 1/k_1 = 1/1000 - 1/3000.
  const DiscSeries law = make({.force_N = 4.0,
                               .working_depth_m = 2_mm,
                               .exponent = 2.0,
                               .exponent_slope = 0.0,
                               .first_depth_m = 1_mm,
                               .discs = 2});
  EXPECT_NEAR(law.stiffness_N_per_m(0), 1500.0, 1e-9);
  EXPECT_NEAR(law.stiffness_N_per_m(1), 3000.0, 1e-9);
  EXPECT_NEAR(law.respond(0.5_mm).force_N, 0.5, 1e-12);
  EXPECT_NEAR(law.respond(1.5_mm).force_N, 2.5, 1e-12);
  EXPECT_NEAR(law.respond(1.5_mm).stiffness_N_per_m, 3000.0, 1e-9);
  // the first disc flat: 1^2 / 3000; the second: 2.5^2 / 6000
  EXPECT_NEAR(law.respond(1.5_mm).energy_J, 1.0 / 3000.0 + 6.25 / 6000.0, 1e-12);
  EXPECT_EQ(law.respond(3_mm).status, law::LawStatus::kSaturated);
  EXPECT_NEAR(law.respond(3_mm).force_N, 4.0, 1e-12) << "beyond the range it stays";
}

/// DS-16, DS-17, by the sum over all discs.
struct Sum {
  double depth_m = 0.0, energy_J = 0.0, soft_m_per_N = 0.0;
};
Sum sum_at(const DiscSeries& law, double force_N) {
  Sum sum;
  for (std::size_t i = 0; i < law.size(); ++i) {
    const double own_N = std::min(force_N, law.flat_force_N(i)), k = law.stiffness_N_per_m(i);
    sum.depth_m += own_N / k;
    sum.energy_J += own_N * own_N / (2.0 * k);
    if (law.flat_force_N(i) > force_N) sum.soft_m_per_N += 1.0 / k;
  }
  return sum;
}

TEST(DiscSeries, IsTheSumOfItsDiscsOnAnyNumbers) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int n = 0; n < 2000; ++n) {
    const DiscSeriesParameters p{.force_N = std::pow(10.0, -2.0 + 3.0 * unit(rng)),
                                 .working_depth_m = 0.002 + 0.03 * unit(rng),
                                 .exponent = 1.2 + 2.0 * unit(rng),
                                 .exponent_slope = 0.01 * (unit(rng) - 0.5),
                                 .first_depth_m = 1e-4 + 1e-3 * unit(rng),
                                 .discs = 2 + rng() % 30};
    const DiscSeries law = make(p);
    const double force_N = p.force_N * std::pow(unit(rng), 3.0);
    const Sum sum = sum_at(law, force_N);
    const law::LawResponse at = law.respond(sum.depth_m);
    ASSERT_NEAR(at.force_N, force_N, 1e-9 * p.force_N) << n;
    ASSERT_NEAR(at.energy_J, sum.energy_J, 1e-9 * p.force_N * p.working_depth_m) << n;
    ASSERT_NEAR(at.stiffness_N_per_m * sum.soft_m_per_N, 1.0, 1e-6) << n;
  }
}

TEST(DiscSeries, ABallIsFollowedWithinThreePercent) { tests::check_follows_ball(make(), 0.03); }

TEST(DiscSeries, AFlatDiscSharesNoFurtherDepth) {
  const DiscSeries law = make();
  std::vector<double> ring_m(20);
  ASSERT_EQ(law.profile(5_mm, ring_m), 10u);
  EXPECT_EQ(ring_m[0], 5_mm);
  EXPECT_EQ(ring_m[9], 0.0);
  EXPECT_NEAR(ring_m[0] - ring_m[1], law.flat_force_N(0) / law.stiffness_N_per_m(0), 1e-12);
}

TEST(DiscSeries, RefusesWhatCannotGoFlatInTurn) {
  const auto message = [](auto change) {
    DiscSeriesParameters p = kSoft;
    change(p);
    const auto made = make_disc_series(p);
    return made ? std::string() : made.error().message;
  };
  EXPECT_NE(message([](auto& p) { p.first_depth_m = 12_mm; }).find("first_depth_m must be below"),
            std::string::npos);
  EXPECT_NE(message([](auto& p) { p.exponent_slope = 0.5; }).find("the stiffness falls"),
            std::string::npos);
  EXPECT_NE(message([](auto& p) { p.exponent = 1.0; }), "");
  EXPECT_NE(message([](auto& p) { p.discs = 1; }), "");
  EXPECT_NE(message([](auto& p) { p.discs = 32; }), "");
  EXPECT_NE(message([](auto& p) { p.force_N = std::nan(""); }), "");
}

}  // namespace tact::model::indent::disc_series_test
