// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/half_space.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tact::tools::reference::half_space_test {

constexpr Elasticity kTissue{.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45};
constexpr double kRadius_m = 5e-3;

TEST(HalfSpace, MatchesPenAndPaper) {
  // 2 * 1000 / (1 - 0.2025) * 0.005 * 0.001 = 12.5392 mN
  EXPECT_NEAR(flat_punch_force_N(kTissue, 5e-3, 1e-3), 12.5392e-3, 1e-7);
}

TEST(HalfSpace, IsHertzAtSmallDepth) {
  // a^2 = R d, F = 4/3 E* sqrt(R) d^(3/2)
  const double d = 1e-6;
  EXPECT_NEAR(sphere_contact_radius_m(kRadius_m, d), std::sqrt(kRadius_m * d), 1e-3 * 7e-5);
  const double hertz_N = 4.0 / 3.0 * kTissue.contact_modulus_Pa() * std::sqrt(kRadius_m * d) * d;
  EXPECT_NEAR(sphere_force_N(kTissue, kRadius_m, d), hertz_N, 1e-3 * hertz_N);
}

TEST(HalfSpace, ForceRisesByThePunchStiffnessOfItsContact) {
  // dF/dd = 2 E* a, whatever the shape of the tool
  for (const double d : {0.5e-3, 2e-3, 5e-3, 12e-3}) {
    const double h = 1e-7;
    const double slope =
        (sphere_force_N(kTissue, kRadius_m, d + h) - sphere_force_N(kTissue, kRadius_m, d - h)) /
        (2.0 * h);
    const double a = sphere_contact_radius_m(kRadius_m, d);
    EXPECT_NEAR(slope, flat_punch_force_N(kTissue, a, 1.0), 1e-5 * slope);
    EXPECT_LT(a, kRadius_m);
  }
}

TEST(HalfSpace, AgreesWithTheIndependentSolution) {
  // Block of radius and height 2 m, E = 1 kPa, nu = 0.45, sphere R = 5 mm, by FEniCS. Its mesh is
  // 0.2 mm at the tip: good to 1 %.
  const double known_mN[][2] = {{1e-3, 3.6639}, {2e-3, 10.1590}, {3e-3, 18.2841}, {5e-3, 37.6647}};
  for (const auto& [depth_m, force_mN] : known_mN)
    EXPECT_NEAR(sphere_force_N(kTissue, kRadius_m, depth_m) * 1e3, force_mN, 0.01 * force_mN);
}

}  // namespace tact::tools::reference::half_space_test
