// SPDX-License-Identifier: Apache-2.0
#include "model/law/linear_pull.h"

#include <gtest/gtest.h>

#include "model/indent/rhombus_chain.h"
#include "model/law/tabulated_law.h"
#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::law::linear_pull_test {

indent::RhombusChain make_chain() {
  return *indent::make_rhombus_chain({.rod_length_m = 5_mm,
                                      .initial_angle_rad = 30_deg,
                                      .normal_stiffness_N_per_m = 150.0,
                                      .tangential_stiffness_N_per_m = 180.0,
                                      .growth = 2.0,
                                      .units = 10});
}

TEST(LinearPull, KeepsTheLawContractDirectlyAndFromATable) {
  const indent::RhombusChain chain = make_chain();
  const LinearPull law = *make_linear_pull(chain, {.stiffness_N_per_m = 60.0, .limit_m = 10_mm});
  tests::check_law_contract(law);
  tests::check_law_contract(*tabulate(law, 65));
}

TEST(LinearPull, PressesAsTheLawAndPullsAsASpring) {
  const indent::RhombusChain chain = make_chain();
  const LinearPull law = *make_linear_pull(chain, {.stiffness_N_per_m = 60.0, .limit_m = 10_mm});
  EXPECT_EQ(law.respond(4_mm).force_N, chain.respond(4_mm).force_N);
  EXPECT_NEAR(law.respond(-4_mm).force_N, -0.24, 1e-12);
  EXPECT_NEAR(law.respond(-12_mm).force_N, -0.6, 1e-12);
  EXPECT_EQ(law.respond(-12_mm).status, LawStatus::kSaturated);
  // U = k L^2 / 2 + k L (12 mm - L)
  EXPECT_NEAR(law.respond(-12_mm).energy_J, 0.5 * 60.0 * 1e-4 + 0.6 * 2e-3, 1e-12);
}

TEST(LinearPull, ATableOfItPullsExactlyLinearlyHoweverStiffThePress) {
  const indent::RhombusChain chain = make_chain();  // 53 N/m at rest
  const LinearPull law = *make_linear_pull(chain, {.stiffness_N_per_m = 2.0, .limit_m = 10_mm});
  const TabulatedLaw table = *tabulate(law, 17);
  for (int i = 1; i <= 100; ++i)
    EXPECT_NEAR(table.respond(-i * 0.1_mm).force_N, -2.0 * i * 0.1_mm, 1e-9);
}

TEST(LinearPull, RefusesNumbersWithoutMeaning) {
  const indent::RhombusChain chain = make_chain();
  EXPECT_FALSE(make_linear_pull(chain, {.stiffness_N_per_m = 0.0, .limit_m = 10_mm}));
  EXPECT_FALSE(make_linear_pull(chain, {.stiffness_N_per_m = 60.0, .limit_m = -1.0}));
}

}  // namespace tact::model::law::linear_pull_test
