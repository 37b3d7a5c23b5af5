// SPDX-License-Identifier: Apache-2.0
#include "model/law/tabulated_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/indent/rhombus_chain.h"
#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::law::tabulated_law_test {

indent::RhombusChain liver() {
  return *indent::make_rhombus_chain({.rod_length_m = 10_mm,
                                      .initial_angle_rad = 30_deg,
                                      .normal_stiffness_N_per_m = 1500.0,
                                      .tangential_stiffness_N_per_m = 1800.0,
                                      .growth = 2.0,
                                      .units = 10});
}

double worst_share_of_limit(const indent::RhombusChain& chain, std::size_t knots) {
  const auto table = tabulate(chain, knots);
  double worst_N = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    const double d = 0.95 * chain.range().press_m * i / 2000.0;
    worst_N = std::max(worst_N, std::abs(table->respond(d).force_N - chain.respond(d).force_N));
  }
  return worst_N / chain.force_limit_N();
}

TEST(TabulatedLaw, KeepsTheLawContract) {
  const indent::RhombusChain chain = liver();
  tests::check_law_contract(*tabulate(chain, 65));
}

TEST(TabulatedLaw, FollowsTheDirectPathAsCloselyAsPublished) {
  // LW-1: 7e-7, 5e-8 and 4e-9 of the largest force for 17, 33 and 65 knots.
  const indent::RhombusChain chain = liver();
  EXPECT_LT(worst_share_of_limit(chain, 17), 2e-6);
  EXPECT_LT(worst_share_of_limit(chain, 33), 2e-7);
  EXPECT_LT(worst_share_of_limit(chain, 65), 1e-8);
  EXPECT_GT(worst_share_of_limit(chain, 17), 1e-7) << "a table that is exact is not a table";
}

TEST(TabulatedLaw, FollowsTheDirectPathWhenPulled) {
  const indent::RhombusChain chain = liver();
  const auto table = tabulate(chain, 65);
  for (int i = 0; i <= 200; ++i) {
    const double d = chain.range().pull_m * i / 200.0;
    EXPECT_NEAR(table->respond(d).force_N, chain.respond(d).force_N, 1e-4 * chain.force_limit_N());
  }
}

TEST(TabulatedLaw, HoldsItsForceBeyondTheLastKnot) {
  const indent::RhombusChain chain = liver();
  const auto table = tabulate(chain, 65);
  const double end_m = table->range().press_m;
  EXPECT_EQ(table->respond(end_m + 5_mm).force_N, table->respond(end_m).force_N);
  EXPECT_EQ(table->respond(end_m + 5_mm).status, LawStatus::kSaturated);
  EXPECT_NEAR(table->respond(end_m + 5_mm).energy_J - table->respond(end_m).energy_J,
              5_mm * table->respond(end_m).force_N, 1e-12);
}

TEST(TabulatedLaw, FitsInto64KilobytesWithEveryKnot) {
  EXPECT_LE(sizeof(TabulatedLaw), 64u * 1024u);
}

TEST(TabulatedLaw, TakesAChainWithoutTangentialSprings) {
  const auto chain = indent::make_rhombus_chain({.rod_length_m = 5_mm,
                                                 .initial_angle_rad = 30_deg,
                                                 .normal_stiffness_N_per_m = 150.0,
                                                 .tangential_stiffness_N_per_m = 0.0,
                                                 .growth = 2.0,
                                                 .units = 10});
  const auto table = tabulate(*chain, 65);
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_NEAR(table->respond(-5_mm).force_N, -15.0 * 5_mm, 1e-12);  // springs in series
}

// A law whose force falls with depth cannot be inverted and must not be felt.
class FallingLaw final : public Law {
 public:
  LawResponse respond(double d) const RT_SAFE override {
    return {d - 100.0 * d * d, 1.0 - 200.0 * d, 0.5 * d * d - 100.0 / 3.0 * d * d * d,
            LawStatus::kOk};
  }
  LawRange range() const RT_SAFE override { return {-1_mm, 20_mm}; }
  std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 1_mm; }
};

TEST(TabulatedLaw, RefusesAForceThatFallsWithDepth) { EXPECT_FALSE(tabulate(FallingLaw(), 65)); }

}  // namespace tact::model::law::tabulated_law_test
