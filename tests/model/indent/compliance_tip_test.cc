// SPDX-License-Identifier: Apache-2.0
#include "model/indent/compliance_tip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/units.h"

namespace tact::model::indent::compliance_tip_test {

constexpr ElasticTip kTip{.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45, .radius_m = 5_mm};

TEST(ComplianceTip, MatchesPenAndPaper) {
  // a = R / 2: ln 3 = 1.0986123; d = 1.25 mm 1.0986123 = 1.3732654 mm; E* = 1000 / 0.7975 Pa
  // F = 1253.9185 [15.625e-6 1.0986123 - 12.5e-6] N = 5.850584e-3 N
  const TipState at = tip_state(kTip, std::atanh(0.5));
  EXPECT_NEAR(at.contact_radius_m, 2.5_mm, 1e-15);
  EXPECT_NEAR(at.depth_m, 1.3732654e-3, 1e-10);
  EXPECT_NEAR(at.force_N, 1253.9184953 * (15.625e-6 * std::log(3.0) - 12.5e-6), 1e-12);
}

constexpr ElasticTip kLarge{
    .youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45, .radius_m = 5_mm, .large_strain = true};

TEST(ComplianceTip, AtLargeStrainMatchesPenAndPaper) {
  // x = ln 3 / 4 = 0.2746531: g = 1 - 0.0332330 + 0.0049107 - 0.0005366
  //                               + 0.1 (0.12795 + 0.0693499) = 0.9908711
  const TipState small = tip_state(kTip, std::atanh(0.5)), at = tip_state(kLarge, std::atanh(0.5));
  EXPECT_NEAR(at.force_N / small.force_N, 0.9908711, 1e-6);
  EXPECT_EQ(at.depth_m, small.depth_m);
  EXPECT_EQ(at.contact_radius_m, small.contact_radius_m);
}

TEST(ComplianceTip, IsHertzForShallowDents) {
  // F = 4/3 E* sqrt(R) d^1.5
  for (const double s : {1e-6, 1e-4, 1e-3, 9.999e-3, 1.0001e-2, 2e-2}) {
    const TipState at = tip_state(kTip, s);
    const double hertz_N = 4.0 / 3.0 * kTip.contact_modulus_Pa() * std::sqrt(kTip.radius_m) *
                           std::pow(at.depth_m, 1.5);
    EXPECT_NEAR(at.force_N / hertz_N, 1.0, s * s + 1e-9) << "s = " << s;
  }
}

TEST(ComplianceTip, StiffnessIsTheSlopeOfTheForce) {
  for (const ElasticTip& tip : {kTip, kLarge})
    for (const double s : {0.005, 0.3, 1.0, 2.1, 3.0}) {
      const TipState a = tip_state(tip, s * (1 - 1e-5)), b = tip_state(tip, s * (1 + 1e-5));
      const double here = tip_state(tip, s).stiffness_N_per_m;
      EXPECT_NEAR((b.force_N - a.force_N) / (b.depth_m - a.depth_m) / here, 1.0, 1e-6) << s;
      EXPECT_LE(here, tip.stiffest_press_N_per_m());
    }
  EXPECT_EQ(tip_state(kTip, 0.3).stiffness_N_per_m,
            2.0 * kTip.contact_modulus_Pa() * tip_state(kTip, 0.3).contact_radius_m);
}

TEST(ComplianceTip, TheForceGrowsAtLargeStrainForEveryPoissonRatio) {
  for (const double nu : {0.0, 0.2, 0.3, 0.45, 0.49, 0.5}) {
    ElasticTip tip = kLarge;
    tip.poisson_ratio = nu;
    for (int i = 0; i < 1000; ++i) {
      const double s = 0.005 * i;
      EXPECT_GT(tip_state(tip, s + 0.005).force_N, tip_state(tip, s).force_N) << nu << " " << s;
      EXPECT_LE(tip_state(tip, s).stiffness_N_per_m, 1.001 * tip.stiffest_press_N_per_m());
    }
  }
}

// Sphere of R = 5 mm, nu = 0.45, E = 1 kPa, block radius 2000 mm, solved with FEniCS (RF-4).
TEST(ComplianceTip, AgreesWithAnIndependentSolution) {
  for (const auto& [depth_m, force_N] :
       {std::pair{1_mm, 3.66392e-3}, std::pair{3_mm, 18.28413e-3}, std::pair{5_mm, 37.66471e-3}}) {
    double low = 0.0, high = 10.0;
    for (int i = 0; i < 100; ++i) {
      const double s = 0.5 * (low + high);
      (tip_state(kTip, s).depth_m < depth_m ? low : high) = s;
    }
    EXPECT_NEAR(tip_state(kTip, low).force_N / force_N, 1.0, 0.002);
  }
}

TEST(ComplianceTip, TheIndentationFollowsTheSphereAndFadesAsThePointForce) {
  const TipState at = tip_state(kTip, 1.2);
  const double a_m = at.contact_radius_m;
  EXPECT_NEAR(pressed_shape_m(kTip, at, 0.0), at.depth_m, 1e-15);
  const double rim_m = pressed_shape_m(kTip, at, a_m * (1.0 - 1e-9));
  EXPECT_NEAR(pressed_shape_m(kTip, at, a_m * (1.0 + 1e-9)), rim_m, 0.01 * at.depth_m);
  // Boussinesq: u = F / (pi E* rho)
  const double far_m = at.force_N / (std::numbers::pi * kTip.contact_modulus_Pa() * 1.0);
  EXPECT_NEAR(pressed_shape_m(kTip, at, 1.0) / far_m, 1.0, 1e-4);
}

TEST(ComplianceTip, APulledDiscIsTheBondedPunch) {
  // RF-5: 12.58298 mN per mm at a = 5 mm; nu -> 1/2: 8 G R.
  EXPECT_NEAR(kTip.pulled_stiffness_N_per_m() / 12.58298, 1.0, 0.002);
  const ElasticTip soft{.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.5, .radius_m = 5_mm};
  EXPECT_NEAR(soft.pulled_stiffness_N_per_m(), 8.0 * 1000.0 / 3.0 * 5_mm, 1e-9);
  EXPECT_EQ(pulled_shape(kTip, 5_mm), 1.0);
  EXPECT_NEAR(pulled_shape(kTip, 10_mm), 1.0 / 3.0, 1e-12);
}

}  // namespace tact::model::indent::compliance_tip_test
