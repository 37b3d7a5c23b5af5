// SPDX-License-Identifier: Apache-2.0
#include "model/indent/rhombus_patch.h"

#include <gtest/gtest.h>

#include <memory>

#include "model/indent/compliance_tip.h"
#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::indent::rhombus_patch_test {

constexpr RhombusPatchParameters kTip{.tip_radius_m = 4_mm, .area_m2 = 1e-6};
// as liver.toml has it
constexpr RhombusChainParameters kLiver{.rod_length_m = 0.653_mm,
                                        .initial_angle_rad = 1.3575,
                                        .normal_stiffness_N_per_m = 1.604,
                                        .tangential_stiffness_N_per_m = 0.8257,
                                        .growth = 6.652,
                                        .units = 10};

RhombusPatch make(const RhombusChainParameters& chain, const RhombusPatchParameters& p = kTip) {
  auto patch = make_rhombus_patch(*make_rhombus_chain(chain), p);
  EXPECT_TRUE(patch) << patch.error().message;
  return *patch;
}

/// A sphere on an elastic half-space, by bisection in CT-1.
double half_space_N(double depth_m) {
  const ElasticTip tip{.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45, .radius_m = 4_mm};
  double low = 0.0, high = 20.0;
  for (int i = 0; i < 100; ++i) {
    const double s = 0.5 * (low + high);
    (tip_state(tip, s).depth_m < depth_m ? low : high) = s;
  }
  return tip_state(tip, low).force_N;
}

TEST(RhombusPatch, KeepsTheLawContract) { tests::check_law_contract(make(kLiver)); }

TEST(RhombusPatch, HasConsistentDimensions) {
  tests::check_dimensions([](double m, double kg, double s) {
    RhombusChainParameters p = kLiver;
    p.rod_length_m *= m;
    p.normal_stiffness_N_per_m *= kg / (s * s);
    p.tangential_stiffness_N_per_m *= kg / (s * s);
    return std::make_unique<RhombusPatch>(
        make(p, {.tip_radius_m = kTip.tip_radius_m * m, .area_m2 = kTip.area_m2 * m * m}));
  });
}

TEST(RhombusPatch, AddsUpTheChainsUnderTheTip) {
  // RC-15 as written: rings of chains under the paraboloid
  const RhombusChain chain = *make_rhombus_chain(kLiver);
  const RhombusPatch patch = make(kLiver);
  for (const double depth_m : {0.5_mm, 3_mm, 12_mm}) {
    const double reach_m = std::sqrt(2.0 * kTip.tip_radius_m * depth_m);
    constexpr int kRings = 4000;
    double sum_N = 0.0;
    for (int i = 0; i < kRings; ++i) {
      const double r_m = reach_m * (i + 0.5) / kRings;
      const double gap_m = r_m * r_m / (2.0 * kTip.tip_radius_m);
      sum_N += 2.0 * std::numbers::pi * r_m * reach_m / kRings / kTip.area_m2 *
               chain.respond(depth_m - gap_m).force_N;
    }
    EXPECT_NEAR(patch.respond(depth_m).force_N / sum_N, 1.0, 1e-5) << depth_m;
  }
}

TEST(RhombusPatch, OfLinearChainsHardensAsTheSquareOfTheDepth) {
  RhombusChainParameters p = kLiver;
  p.tangential_stiffness_N_per_m = 0.0;
  const RhombusPatch patch = make(p);
  // pi R / A * kN / 10 d^2 = 12566.4 / m * 0.1604 N/m * 4e-6 m^2
  EXPECT_NEAR(patch.respond(2_mm).force_N, 8.06258e-3, 1e-7);
  EXPECT_NEAR(patch.respond(4_mm).force_N / patch.respond(2_mm).force_N, 4.0, 1e-9);
}

TEST(RhombusPatch, FollowsASphereOnAHalfSpaceFromLightTouchToFourRadii) {
  const RhombusPatch patch = make(kLiver);
  for (double depth_m = 0.5_mm; depth_m < 18_mm; depth_m *= 1.1)
    EXPECT_NEAR(patch.respond(depth_m).force_N / half_space_N(depth_m), 1.0, 0.0205) << depth_m;
}

TEST(RhombusPatch, IndentationIsTheTipItself) {
  const RhombusPatch patch = make(kLiver);
  std::vector<double> ring_m(64);
  const std::size_t count = patch.profile(5_mm, ring_m);
  const double pitch_m = patch.ring_pitch_m();
  EXPECT_NEAR(ring_m[4], 5_mm - 16.0 * pitch_m * pitch_m / 8_mm, 1e-12);
  EXPECT_EQ(ring_m[count - 1], 0.0);
  EXPECT_EQ(patch.profile(-5_mm, ring_m), count);
  EXPECT_EQ(ring_m[0], 0.0) << "it cannot pull";
}

TEST(RhombusPatch, RefusesParametersWithoutMeaning) {
  const RhombusChain chain = *make_rhombus_chain(kLiver);
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    EXPECT_FALSE(make_rhombus_patch(chain, {.tip_radius_m = bad, .area_m2 = 1e-6}));
    EXPECT_FALSE(make_rhombus_patch(chain, {.tip_radius_m = 4_mm, .area_m2 = bad}));
  }
}

}  // namespace tact::model::indent::rhombus_patch_test
