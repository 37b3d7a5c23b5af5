// SPDX-License-Identifier: Apache-2.0
#include "model/indent/large_strain_law.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "model/indent/compliance_law.h"
#include "model/indent/hunt_crossley.h"
#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::indent::large_strain_law_test {

constexpr std::size_t kKnots = 65;
constexpr ElasticTip kTip{.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45, .radius_m = 4_mm};

/// A half-space under the tip.
ComplianceCurve half_space(ElasticTip tip) {
  auto curve = make_compliance_curve({.tip = tip,
                                      .working_depth_m = 8_mm,
                                      .ring_pitch_m = 2_mm,
                                      .ring_m_per_N = std::array{0.0},
                                      .table_knots = kKnots});
  EXPECT_TRUE(curve) << curve.error().message;
  return *curve;
}

LargeStrainLaw made(const law::Law& small, const ElasticTip& tip = kTip) {
  auto law = make_large_strain_law(small, tip, kKnots);
  EXPECT_TRUE(law) << law.error().message;
  return *law;
}

TEST(LargeStrainLaw, KeepsTheLawContract) {
  for (const double poisson_ratio : {0.3, 0.45, 0.5}) {
    ElasticTip tip = kTip;
    tip.poisson_ratio = poisson_ratio;
    const ComplianceCurve small = half_space(tip);
    tests::check_law_contract(made(small, tip));
    const auto power = make_hunt_crossley(
        {.force_N = 0.5, .working_depth_m = 12_mm, .exponent = 1.4, .dissipation_s_per_m = 0.1});
    ASSERT_TRUE(power);
    tests::check_law_contract(made(*power, tip));
  }
}

TEST(LargeStrainLaw, OfAHalfSpaceIsTheTipAtLargeStrain) {
  for (const double poisson_ratio : {0.3, 0.45, 0.5}) {
    ElasticTip tip = kTip;
    tip.poisson_ratio = poisson_ratio;
    const ComplianceCurve small = half_space(tip);
    tip.large_strain = true;
    const ComplianceCurve truth = half_space(tip);
    const LargeStrainLaw law = made(small, tip);
    for (double depth_m = 0.5_mm; depth_m < 8_mm; depth_m += 0.25_mm)
      EXPECT_NEAR(law.respond(depth_m).force_N / truth.respond(depth_m).force_N, 1.0, 2e-4)
          << depth_m;
    EXPECT_EQ(law.respond(-2_mm).force_N, truth.respond(-2_mm).force_N) << "pull stays";
  }
}

// nu = 0.45, x = 1: a/R = tanh(1.19968) = 0.833557,
// g = 1 - 0.1210 + 0.0651 - 0.0259 + 0.1 (0.2559 * 0.833557 + 0.2525) = 0.964781
TEST(LargeStrainLaw, SoftensByTheFactorOfTheTip) {
  const StrainFactor at = large_strain_factor(0.45, 1.0);
  EXPECT_NEAR(at.factor, 0.964781, 1e-6);
  const double ahead = large_strain_factor(0.45, 1.0 + 1e-6).factor,
               behind = large_strain_factor(0.45, 1.0 - 1e-6).factor;
  EXPECT_NEAR((ahead - behind) / 2e-6, at.slope, 1e-6);
}

/// 1 N from 1 mm on.
class Yielding final : public law::Law {
 public:
  law::LawResponse respond(double depth_m) const RT_SAFE override {
    const double x = std::fmin(depth_m / 1_mm, 1.0);
    return {.force_N = x, .stiffness_N_per_m = x < 1.0 ? 1000.0 : 0.0};
  }
  law::LawRange range() const RT_SAFE override { return {.press_m = 8_mm}; }
  std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 1_mm; }
};

TEST(LargeStrainLaw, RefusesAForceThatWouldFall) {
  const Yielding yielding;
  const auto law = make_large_strain_law(yielding, kTip, kKnots);
  ASSERT_FALSE(law);
  EXPECT_NE(law.error().message.find("large_strain = false"), std::string::npos);
}

}  // namespace tact::model::indent::large_strain_law_test
