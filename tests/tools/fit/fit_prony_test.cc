// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_prony.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace tact::tools::fit::fit_prony_test {

using model::law::PronyTerm;

/// 30 s, dense at first, as a bench samples it.
std::vector<HeldForce> made(const std::vector<PronyTerm>& terms, double initial_N) {
  std::vector<HeldForce> held;
  for (int i = 0; i <= 120; ++i) {
    const double t = i == 0 ? 0.0 : 0.01 * std::pow(3000.0, (i - 1) / 119.0);
    double force_N = initial_N;
    for (const PronyTerm& term : terms)
      force_N -= initial_N * term.share * (1.0 - std::exp(-t / term.time_s));
    held.push_back({t, force_N});
  }
  return held;
}

void expect_found(const std::vector<PronyTerm>& terms, std::size_t asked) {
  const auto fit = fit_prony(made(terms, 0.8), {.terms = asked, .good_residual = 1e-3});
  ASSERT_TRUE(fit) << fit.error().message;
  ASSERT_EQ(fit->terms.size(), terms.size());
  EXPECT_NEAR(fit->initial_N, 0.8, 0.002);
  EXPECT_LT(fit->residual_ratio, 1e-3);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    EXPECT_NEAR(fit->terms[i].share, terms[i].share, 0.02 * terms[i].share + 0.002);
    EXPECT_NEAR(fit->terms[i].time_s, terms[i].time_s, 0.03 * terms[i].time_s);
  }
}

TEST(FitProny, FindsOneTerm) { expect_found({{0.4, 2.0}}, 0); }
// The illustrative set of the liver scene.
TEST(FitProny, FindsTwoTerms) { expect_found({{0.3, 0.5}, {0.2, 8.0}}, 0); }
TEST(FitProny, FindsThreeTerms) { expect_found({{0.2, 0.1}, {0.25, 1.0}, {0.2, 10.0}}, 3); }

TEST(FitProny, TakesTheFewestTermsThatAreGoodEnough) {
  const auto held = made({{0.3, 0.5}, {0.01, 8.0}}, 1.0);
  const auto fit = fit_prony(held, {});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->terms.size(), 1U);
  EXPECT_TRUE(fit->is_good);
  const auto exact = fit_prony(held, {.good_residual = 1e-4});
  ASSERT_TRUE(exact);
  EXPECT_EQ(exact->terms.size(), 2U);
}

TEST(FitProny, SharesNeverGoBelowZeroNorAboveOne) {
  std::vector<HeldForce> rising;  // no relaxation has this
  for (int i = 0; i < 20; ++i) rising.push_back({0.1 * i, 1.0 + 0.02 * i});
  const auto fit = fit_prony(rising, {.terms = 2});
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->terms.empty());
  EXPECT_FALSE(fit->is_good);
}

TEST(FitProny, DataWithoutARelaxationIsRefused) {
  EXPECT_FALSE(fit_prony({{0.0, 1.0}, {1.0, 0.5}}, {}));
  auto held = made({{0.4, 2.0}}, 1.0);
  held[3].time_s = held[2].time_s;
  EXPECT_FALSE(fit_prony(held, {}));
  held = made({{0.4, 2.0}}, -1.0);
  EXPECT_FALSE(fit_prony(held, {}));
}

}  // namespace tact::tools::fit::fit_prony_test
