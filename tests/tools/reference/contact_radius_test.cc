// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/contact_radius.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/shapes.h"
#include "tools/reference/press/half_space.h"

namespace tact::tools::reference::contact_radius_test {

constexpr Elasticity kTissue{.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45};
constexpr double kRadius_m = 4e-3;
constexpr double kPitch_m = 0.25e-3;

TEST(TipContact, OnAFlatSurfaceIsTheHalfSpace) {
  const TipContact tip(kTissue, kRadius_m, {}, kPitch_m);
  for (const double depth_m : {0.5e-3, 2e-3, 5e-3, 8e-3}) {
    const double a_m = sphere_contact_radius_m(kRadius_m, depth_m);
    EXPECT_NEAR(tip.depth_m(a_m), depth_m, 1e-4 * depth_m);
    const double force_N = sphere_force_N(kTissue, kRadius_m, depth_m);
    EXPECT_NEAR(tip.force_N(a_m), force_N, 1e-4 * force_N);
    EXPECT_NEAR(tip.radius_m(depth_m, 0.0), a_m, 1e-4 * a_m);
  }
}

TEST(TipContact, OnABallIsHertzOfBothRadii) {
  // s = rho^2 / (2 Rs) is a paraboloid: at small depth 1/R + 1/Rs act together.
  std::vector<double> fall_m;
  const double ball_m = 12e-3, pitch_m = 1e-6;
  for (int k = 0; k < 400; ++k) fall_m.push_back(std::pow(k * pitch_m, 2) / (2.0 * ball_m));
  const TipContact tip(kTissue, kRadius_m, fall_m, pitch_m);
  const double both_m = 1.0 / (1.0 / kRadius_m + 1.0 / ball_m), a_m = 0.2e-3;
  // a^2 = R d, F = 4/3 E* a^3 / R
  EXPECT_NEAR(tip.depth_m(a_m), a_m * a_m / both_m, 2e-3 * a_m * a_m / both_m);
  const double hertz_N = 4.0 / 3.0 * kTissue.contact_modulus_Pa() * a_m * a_m * a_m / both_m;
  EXPECT_NEAR(tip.force_N(a_m), hertz_N, 3e-3 * hertz_N);
}

TEST(TipContact, TakesTheGiveOfTheOrganFromOneSolve) {
  // An organ of known give: F and d belong to a = 2.5 mm. The contact at another depth obeys it.
  const TipContact tip(kTissue, kRadius_m, {}, kPitch_m);
  const double give = 0.02;  // m/N
  const double force_N = tip.force_N(2.5e-3), depth_m = tip.depth_m(2.5e-3) + give * force_N;
  EXPECT_NEAR(tip.compliance_m_per_N(depth_m, force_N), give, 1e-9);
  EXPECT_NEAR(tip.radius_m(depth_m, give), 2.5e-3, 1e-9);
  EXPECT_LT(tip.radius_m(7e-3, give), tip.radius_m(7e-3, 0.0)) << "what gives way is touched less";
}

TEST(SurfaceFall, OfABallIsItsCap) {
  const model::mesh::SurfaceMesh ball = tests::make_ball(0.03, 5);
  const auto found = surface_fall_m(ball, 4, 17, kPitch_m);
  ASSERT_TRUE(found) << found.error().message;
  const std::vector<double>& fall_m = *found;
  ASSERT_EQ(fall_m.size(), 17U);
  EXPECT_EQ(fall_m[0], 0.0);
  for (std::size_t k = 4; k < 17; ++k) {
    const double rho_m = static_cast<double>(k) * kPitch_m;
    EXPECT_NEAR(fall_m[k], 0.03 - std::sqrt(0.03 * 0.03 - rho_m * rho_m), 0.02e-3) << k;
  }
}

TEST(SurfaceFall, OfAPlateIsNothing) {
  const auto flat = surface_fall_m(tests::make_plate(0.1, 10), 60, 17, kPitch_m);
  ASSERT_TRUE(flat) << flat.error().message;
  for (const double fall_m : *flat) EXPECT_NEAR(fall_m, 0.0, 1e-15);
}

}  // namespace tact::tools::reference::contact_radius_test
