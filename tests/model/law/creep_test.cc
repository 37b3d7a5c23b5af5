// SPDX-License-Identifier: Apache-2.0
#include "model/law/creep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tact::model::law::creep_test {

constexpr double kTick_s = 1e-4;

/// The largest error of the strain that creep finds for the stress of a constant strain of 1.
double worst_strain_error(const std::vector<PronyTerm>& terms) {
  const auto relaxation = make_relaxation(terms, kTick_s);
  EXPECT_TRUE(relaxation);
  const Creep creep(*relaxation);
  EXPECT_EQ(creep.terms(), terms.size());
  CreepState state;
  double worst = 0.0;
  for (int i = 0; i < 30000; ++i) {
    double stress = relaxation->share(0);
    for (const PronyTerm& term : terms) stress += term.share * std::exp(-i * kTick_s / term.time_s);
    const Vec3 load_N{stress, 0.0, 0.0};
    worst = std::max(worst, std::abs((load_N + creep.crept_N(state)).x - 1.0));
    creep.advance(state, load_N);
  }
  return worst;
}

// R and J are inverse to each other: the stress of a constant strain, as a load, gives it back.
TEST(Creep, GivesBackTheConstantStrainOfARelaxingStress) {
  EXPECT_LT(worst_strain_error({{.share = 0.5, .time_s = 0.3}}), 1e-3);
  EXPECT_LT(worst_strain_error({{.share = 0.3, .time_s = 0.1}, {.share = 0.4, .time_s = 2.0}}),
            1e-3);
  EXPECT_LT(worst_strain_error({{.share = 0.2, .time_s = 1.0},
                                {.share = 0.3, .time_s = 0.05},
                                {.share = 0.3, .time_s = 5.0}}),
            2e-3);
}

TEST(Creep, FlowsWithoutEndWhereAllOfTheForceFades) {
  EXPECT_LT(worst_strain_error({{.share = 1.0, .time_s = 0.3}}), 1e-3);
}

TEST(Creep, MaterialWithoutRelaxationDoesNotCreep) {
  EXPECT_EQ(Creep().terms(), 0U);
  EXPECT_EQ(Creep().crept_N({}), Vec3{});
}

}  // namespace tact::model::law::creep_test
