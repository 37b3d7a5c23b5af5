// SPDX-License-Identifier: Apache-2.0
// Spheres that press one tissue, as mathematics: MC-1 is solved, and its energy is a potential.
#include "model/contact/coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "model/units.h"
#include "tests/support/no_alloc.h"
#include "tests/support/soft_half_space.h"

namespace tact::model::contact::coupling_test {

constexpr double kRadius_m = 4_mm, kYoungs_Pa = 5000.0, kPoisson = 0.45;

using HalfSpace = tests::SoftHalfSpace;

struct Group {
  std::vector<PressingSphere> sphere;
  Coupling c{};

  Group(ContactLaw& law, const std::vector<Vec3>& at_m, const std::vector<double>& depth_m,
        bool held = false) {
    for (std::size_t i = 0; i < at_m.size(); ++i)
      sphere.push_back(
          {.presses = true,
           .depth_m = depth_m[i],
           .in = {.sphere = i, .normal = {0, 0, 1}, .indentation_m = depth_m[i], .held = held},
           .response = {}});
    for (std::size_t i = 0; i < at_m.size(); ++i)
      for (std::size_t j = 0; j < at_m.size(); ++j)
        if (i != j)
          c[i][j] =
              law.coupling(sphere[i].in, sphere[j].in, norm(at_m[i] - at_m[j])).near_field_m_per_N;
  }
  double force_N(std::size_t i) const { return sphere[i].response.law.force_N; }
  double miss_m(std::size_t i) const {
    return sphere[i].depth_m - coupled_m(c, sphere, i) - sphere[i].in.indentation_m;
  }
};

std::vector<Vec3> random_places(std::mt19937& random, std::size_t n) {
  std::uniform_real_distribution<double> side(-15_mm, 15_mm);
  std::vector<Vec3> at_m;
  while (at_m.size() < n) {
    const Vec3 p{side(random), side(random), 0};
    if (std::ranges::all_of(at_m, [&](const Vec3& q) { return norm(p - q) > 2 * kRadius_m; }))
      at_m.push_back(p);
  }
  return at_m;
}

TEST(Coupling, HalfSpacePairSharesItsTissue) {
  HalfSpace half;
  Group pair(half.field, {{0, 0, 0}, {8_mm, 0, 0}}, {5_mm, 5_mm});
  press_together(half.field, pair.c, pair.sphere);
  // By hand: F = F_law(d - F / (pi E* 8 mm))
  double low_N = 0.0, high_N = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double f_N = 0.5 * (low_N + high_N);
    const double indentation_m =
        5_mm - f_N / (std::numbers::pi * half.tip.contact_modulus_Pa() * 8_mm);
    (half.curve.respond(indentation_m).force_N > f_N ? low_N : high_N) = f_N;
  }
  EXPECT_NEAR(pair.force_N(0), low_N, 1e-7 * low_N);
  EXPECT_EQ(pair.force_N(0), pair.force_N(1));
  EXPECT_LT(pair.force_N(0), 0.85 * half.curve.respond(5_mm).force_N);
}

TEST(Coupling, SolvesEveryGroupFromAnyGuess) {
  HalfSpace half;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> depth(-2_mm, 11_mm);
  for (int k = 0; k < 20'000; ++k) {
    const std::size_t n = 2 + random() % 3;
    std::vector<double> depth_m(n);
    for (double& d : depth_m) d = depth(random);
    Group group(half.field, random_places(random, n), depth_m, k % 3 == 0);
    for (PressingSphere& s : group.sphere) s.in.indentation_m = depth(random);
    press_together(half.field, group.c, group.sphere);
    for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(group.miss_m(i), 0.0, 1e-10) << k;
  }
}

TEST(Coupling, ASphereInTheIndentationOfAnotherNeverPulls) {
  HalfSpace half;
  Group pair(half.field, {{0, 0, 0}, {8_mm, 0, 0}}, {10_mm, 0.5_mm});
  press_together(half.field, pair.c, pair.sphere);
  EXPECT_LT(pair.sphere[1].in.indentation_m, 0.0);
  EXPECT_EQ(pair.force_N(1), 0.0);
  EXPECT_EQ(pair.force_N(0), half.curve.respond(10_mm).force_N);
}

TEST(Coupling, EachForceIsTheSlopeOfTheOneEnergy) {
  HalfSpace half;
  std::mt19937 random(6);
  std::uniform_real_distribution<double> depth(-1_mm, 10_mm);
  const auto energy_J = [&](Group group) {
    return press_together(half.field, group.c, group.sphere);
  };
  for (int k = 0; k < 500; ++k) {
    const std::size_t n = 2 + random() % 3;
    std::vector<double> depth_m(n);
    for (double& d : depth_m) d = depth(random);
    Group group(half.field, random_places(random, n), depth_m, k % 2 == 0);
    press_together(half.field, group.c, group.sphere);
    for (std::size_t i = 0; i < n; ++i) {
      constexpr double kStep_m = 1e-7;
      Group ahead = group, behind = group;
      ahead.sphere[i].depth_m += kStep_m;
      behind.sphere[i].depth_m -= kStep_m;
      EXPECT_NEAR((energy_J(ahead) - energy_J(behind)) / (2 * kStep_m), group.force_N(i), 2e-6)
          << k << ", sphere " << i;
    }
  }
}

TEST(Coupling, ALobeBendsAlongOneAxisBetweenNormalsThatStraddleIt) {
  const ContactCoupling tissue{.near_field_m_per_N = 0.006, .structural_m_per_N = 0.05};
  const auto at = [&](double apart_rad) {
    return coupling_m_per_N(tissue, {0, 0, 1}, {std::sin(apart_rad), 0, std::cos(apart_rad)});
  };
  EXPECT_NEAR(at(0.0), 0.056, 1e-15);
  EXPECT_NEAR(at(28_deg), 0.883 * 0.006 + 0.980 * 0.05, 1e-4) << "each 14 degrees from the axis";
  EXPECT_NEAR(at(90_deg), 0.0, 1e-15);
  EXPECT_NEAR(at(180_deg), -0.056, 1e-15) << "a pinched lobe";
}

TEST(Coupling, UncoupledSphereHasExactlyTheForceOfItsOwnDepth) {
  HalfSpace half;
  Group one(half.field, {{0, 0, 0}}, {3.3_mm});
  one.sphere[0].in.indentation_m = 1_mm;
  press_together(half.field, one.c, one.sphere);
  EXPECT_EQ(one.force_N(0), half.curve.respond(3.3_mm).force_N);
}

TEST(Coupling, IndefiniteCouplingIsReducedUntilItIsDefinite) {
  HalfSpace half;
  Group pair(half.field, {{0, 0, 0}, {8_mm, 0, 0}}, {8_mm, 8_mm});
  const double k = half.field.stiffest_N_per_m(pair.sphere[0].in.surface_point, false);
  EXPECT_EQ(definite_share(pair.c, {k, k}), 1.0);
  // a stiff contact point that sinks more with its neighbour's force
  pair.c[0][1] = pair.c[1][0] = 2.0 / k;
  const double share = definite_share(pair.c, {k, k});
  EXPECT_NEAR(share, 0.5 * 0.95, 1e-3);
}

TEST(Coupling, AGroupWithoutOneSolutionIsCoupledLess) {
  HalfSpace half;
  for (const double times : {1.0, 1.5, 2.0, 20.0}) {
    Group pair(half.field, {{0, 0, 0}, {8_mm, 0, 0}}, {8_mm, 2_mm});
    press_together(half.field, pair.c, pair.sphere);
    const double k = pair.sphere[0].response.law.stiffness_N_per_m;
    pair.c[0][1] = pair.c[1][0] = times / k;
    press_together(half.field, pair.c, pair.sphere);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(pair.miss_m(i), 0.0, 1e-10) << times;
      EXPECT_TRUE(std::isfinite(pair.force_N(i)));
    }
  }
}

TEST(Coupling, LeavesTheHeapAlone) {
  HalfSpace half;
  Group group(half.field, {{0, 0, 0}, {9_mm, 0, 0}, {0, 9_mm, 0}}, {3_mm, 5_mm, 1_mm});
  const tests::NoAlloc guard;
  press_together(half.field, group.c, group.sphere);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::contact::coupling_test
