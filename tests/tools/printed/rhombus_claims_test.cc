// SPDX-License-Identifier: Apache-2.0
// What the source of the rhombus chain claims and what does not hold (X1 to X7).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/indent/rhombus_chain.h"
#include "model/units.h"
#include "tools/printed/rhombus_paper.h"

namespace tact::tools::printed::rhombus_claims_test {

using namespace model;
using namespace model::indent;

constexpr double kBeta = 2.0;
constexpr double kCut = 0.05;  // of lambda

/// Unit i = 1, 2, ... of the printed liver, in N/mm so that it can be felt; (11) unless `alike`.
RhombusUnit unit(int i, double angle_rad = 30_deg, bool alike = false) {
  return {.rod_length_m = 10_mm,
          .initial_angle_rad = angle_rad,
          .normal_stiffness_N_per_m = 1500.0,
          .tangential_stiffness_N_per_m = 1800.0 * (alike ? 1.0 : std::exp((i - 1) / kBeta))};
}

struct Cut {
  int units = 0;         // the leading run with lambda >= 0.05
  double depth_m = 0.0;  // of these
  double whole_m = 0.0;  // of all ten
};

/// The source's rule: the first unit with lambda < 0.05, and all beyond it, stay as they are.
Cut cut(double force_N, bool alike = false) {
  Cut out;
  bool goes_on = true;
  for (int i = 1; i <= 10; ++i) {
    const RhombusUnit u = unit(i, 30_deg, alike);
    const double x_m = shortening_at(u, press_limit(u), force_N);
    out.whole_m += x_m;
    goes_on = goes_on && respond(u, x_m).lambda >= kCut;
    if (!goes_on) continue;
    ++out.units;
    out.depth_m += x_m;
  }
  return out;
}

// X1  the tangential spring resists; as printed it helps the load.
TEST(RhombusClaims, X1TheTangentialSpringSoftensWhatItShouldStiffen) {
  RhombusUnit soft = unit(1), stiff = unit(1);
  stiff.tangential_stiffness_N_per_m *= 2.0;
  EXPECT_GT(respond(stiff, 0.0).stiffness_N_per_m, respond(soft, 0.0).stiffness_N_per_m);
  EXPECT_LT(paper_initial_stiffness_N_per_m(stiff), paper_initial_stiffness_N_per_m(soft));
}

// X2  with (11) no angle is safe: some unit down the chain turns negative.
TEST(RhombusClaims, X2AtEveryAngleSomeUnitOfThePrintedChainIsSingular) {
  for (double degrees = 1.0; degrees < 90.0; degrees += 1.0) {
    const double angle_rad = degrees * M_PI / 180.0;
    const double t = std::tan(angle_rad);
    const double last = 1.0 + kBeta * std::log(1500.0 / (1800.0 * t * t));  // where D0 = 0
    EXPECT_TRUE(paper_is_singular(unit(static_cast<int>(std::floor(last)) + 1, angle_rad)));
    const int before = static_cast<int>(std::ceil(last)) - 1;
    if (before < 1) continue;
    EXPECT_FALSE(paper_is_singular(unit(before, angle_rad))) << degrees;
  }
}

// X3  (8) and (9) give every unit the first one's springs: the lambda rule stops all or none.
TEST(RhombusClaims, X3WithTheFirstUnitsSpringsTheLambdaRuleCannotAct) {
  bool none = false, all = false, some = false;
  for (double force_N = 0.05; force_N < 14.0; force_N += 0.05) {
    const Cut alike = cut(force_N, true);
    EXPECT_TRUE(alike.units == 0 || alike.units == 10) << force_N;
    none |= alike.units == 0;
    all |= alike.units == 10;
    const Cut grown = cut(force_N);
    some |= grown.units > 0 && grown.units < 10;
  }
  EXPECT_TRUE(none && all && some);
}

// X4  (12) divides energy by displacement: half of the force, 0.5007 to 0.585 over the range.
TEST(RhombusClaims, X4EnergyOverDisplacementIsHalfTheForce) {
  for (const auto& [share, ratio] : {std::pair{0.01, 0.5007}, {0.1, 0.5070}, {0.3, 0.5221}}) {
    const double force_N = share * 15.0;
    double depth_m = 0.0, energy_J = 0.0;
    for (int i = 1; i <= 10; ++i) {
      const double x_m = shortening_at(unit(i), press_limit(unit(i)), force_N);
      depth_m += x_m;
      energy_J += respond(unit(i), x_m).energy_J;
    }
    EXPECT_NEAR(energy_J / depth_m / force_N, ratio, 5e-5);
  }
}

// X5  projected with the undeformed angle the force is not the slope of the energy.
TEST(RhombusClaims, X5TheUndeformedAngleGivesAnotherForceThanTheEnergy) {
  const RhombusUnit u = unit(1);
  const double x_m = 3_mm, h = 1e-8;
  const UnitResponse at = respond(u, x_m);
  const double slope_N = (respond(u, x_m + h).energy_J - respond(u, x_m - h).energy_J) / (2.0 * h);
  EXPECT_NEAR(at.force_N, slope_N, 1e-6 * slope_N);
  const double spring_N = u.tangential_stiffness_N_per_m * at.widening_m;
  const double undeformed_N =
      u.normal_stiffness_N_per_m * x_m + spring_N * std::tan(u.initial_angle_rad);
  EXPECT_GT(undeformed_N, 1.05 * slope_N);
}

// X6  kN, kT in N/m, as printed, move a 20 N device by 15 mN at most: N/mm must be meant.
TEST(RhombusClaims, X6ThePrintedUnitsGiveNoNoticeableForce) {
  const auto chain = make_rhombus_chain({.rod_length_m = 10_mm,
                                         .initial_angle_rad = 30_deg,
                                         .normal_stiffness_N_per_m = 1.5,
                                         .tangential_stiffness_N_per_m = 1.8,
                                         .growth = kBeta,
                                         .units = 10});
  ASSERT_TRUE(chain) << chain.error().message;
  EXPECT_NEAR(chain->respond(1.0).force_N, 0.015, 1e-5);
  EXPECT_LT(chain->respond(1.0).force_N, 20.0 / 1000.0);
}

// X7  the lambda cut: no depth at all up to a force, then jumps.
TEST(RhombusClaims, X7TheLambdaCutHasADeadZoneAndJumps) {
  EXPECT_EQ(cut(0.01 * 15.0).units, 0);  // 0.28 mm deep, and shown as untouched
  EXPECT_EQ(cut(0.061 * 15.0).units, 0);
  EXPECT_EQ(cut(0.063 * 15.0).units, 1);
  EXPECT_NEAR(cut(0.01 * 15.0).whole_m, 0.2841_mm, 1e-7);
  EXPECT_EQ(cut(0.1 * 15.0).units, 3);
  EXPECT_NEAR(cut(0.1 * 15.0).depth_m, 1.881_mm, 1e-6);
  double largest_jump_m = 0.0, largest_step_m = 0.0;
  constexpr double kStep_N = 1e-3;
  for (double force_N = kStep_N; force_N < 3.0; force_N += kStep_N) {
    const Cut before = cut(force_N - kStep_N), after = cut(force_N);
    largest_jump_m = std::max(largest_jump_m, after.depth_m - before.depth_m);
    largest_step_m = std::max(largest_step_m, after.whole_m - before.whole_m);
  }
  EXPECT_NEAR(largest_jump_m, 0.46_mm, 0.01_mm);
  EXPECT_LT(largest_step_m, 0.01_mm) << "the chain itself is smooth";
}

// "With the force the indented part grows ever more slowly": so it is, by the source's own rule.
TEST(RhombusClaims, TheDentedPartGrowsEverMoreSlowlyWithTheForce) {
  EXPECT_EQ(cut(0.1 * 15.0).units, 3);
  EXPECT_EQ(cut(0.3 * 15.0).units, 6);
  EXPECT_EQ(cut(0.6 * 15.0).units, 8);
  EXPECT_EQ(cut(0.9 * 15.0).units, 8);
}

// "Other rods and angles are other tissues": angles are, rods only reach farther.
TEST(RhombusClaims, RodsOfAnotherLengthAreNoOtherStiffness) {
  const auto chain = [](double rod_m, double angle_rad) {
    return *make_rhombus_chain({.rod_length_m = rod_m,
                                .initial_angle_rad = angle_rad,
                                .normal_stiffness_N_per_m = 1500.0,
                                .tangential_stiffness_N_per_m = 1800.0,
                                .growth = kBeta,
                                .units = 10});
  };
  const auto at_rest_N_per_m = [&chain](double rod_m, double angle_rad) {
    return chain(rod_m, angle_rad).at_force(0.0).stiffness_N_per_m;
  };
  EXPECT_NEAR(at_rest_N_per_m(20_mm, 30_deg), at_rest_N_per_m(5_mm, 30_deg), 1e-9);
  EXPECT_NEAR(chain(20_mm, 30_deg).range().press_m / chain(5_mm, 30_deg).range().press_m, 4.0,
              1e-9);
  EXPECT_NEAR(at_rest_N_per_m(10_mm, 10_deg), 223.0, 0.5);
  EXPECT_NEAR(at_rest_N_per_m(10_mm, 60_deg), 2495.0, 0.5);
}

}  // namespace tact::tools::printed::rhombus_claims_test
