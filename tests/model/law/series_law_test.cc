// SPDX-License-Identifier: Apache-2.0
#include "model/law/series_law.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "model/indent/compliance_law.h"
#include "model/indent/rhombus_chain.h"
#include "model/law/law_bounds.h"
#include "model/law/tabulated_law.h"
#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::law::series_law_test {

constexpr std::array kRings{0.01, 0.005};

indent::ComplianceCurve place(double compliance_m_per_N, double m = 1.0, double kg = 1.0,
                              double s = 1.0) {
  const double per_N = s * s / kg;
  const std::array rings{kRings[0] * per_N, kRings[1] * per_N};
  auto curve =
      indent::make_compliance_curve({.tip = {.youngs_modulus_Pa = 5000.0 * kg / (m * s * s),
                                             .poisson_ratio = 0.45,
                                             .radius_m = 4_mm * m},
                                     .regular_m_per_N = compliance_m_per_N * per_N,
                                     .working_depth_m = 12_mm * m,
                                     .ring_pitch_m = 2_mm * m,
                                     .ring_m_per_N = rings,
                                     .table_knots = 257});
  EXPECT_TRUE(curve) << curve.error().message;
  return *curve;
}

/// The tip's own indentation, pressed and pulled, in series with a compliance.
struct Pair {
  Pair(double compliance_m_per_N, double m = 1.0, double kg = 1.0, double s = 1.0)
      : tip(place(0.0, m, kg, s)),
        series(*make_series_law(tip, compliance_m_per_N * s * s / kg, tip)) {}
  indent::ComplianceCurve tip;
  SeriesLaw series;
};

class PairLaw final : public Law {
 public:
  PairLaw(double compliance_m_per_N, double m, double kg, double s)
      : pair_(compliance_m_per_N, m, kg, s) {}
  LawResponse respond(double d) const RT_SAFE override { return pair_.series.respond(d); }
  LawRange range() const RT_SAFE override { return pair_.series.range(); }
  std::size_t profile(double d, std::span<double> u) const RT_SAFE override {
    return pair_.series.profile(d, u);
  }
  double ring_pitch_m() const RT_SAFE override { return pair_.series.ring_pitch_m(); }

 private:
  Pair pair_;
};

TEST(SeriesLaw, KeepsTheLawContractWhereTheOrganGivesAndWhereItIsHeld) {
  const indent::RhombusChain chain =
      *indent::make_rhombus_chain({.rod_length_m = 5_mm,
                                   .initial_angle_rad = 0.5236,
                                   .normal_stiffness_N_per_m = 126.0,
                                   .tangential_stiffness_N_per_m = 76.0,
                                   .growth = 2.0,
                                   .units = 10});
  const TabulatedLaw table = *tabulate(chain, kMaxKnots);
  for (const double compliance_m_per_N : {0.03, 0.0, -0.003})
    tests::check_law_contract(*make_series_law(table, compliance_m_per_N, table));
}

TEST(SeriesLaw, HasConsistentDimensions) {
  tests::check_dimensions(
      [](double m, double kg, double s) { return std::make_unique<PairLaw>(0.03, m, kg, s); });
}

TEST(SeriesLaw, SeriesWithItsOwnTipMatchesTheComplianceLaw) {
  for (const double compliance_m_per_N : {0.03, -0.005}) {
    const Pair pair(compliance_m_per_N);
    const indent::ComplianceCurve whole = place(compliance_m_per_N);
    for (const double depth_m : {-8_mm, -1_mm, 0.5_mm, 2_mm, 6_mm}) {
      const LawResponse a = pair.series.respond(depth_m), b = whole.respond(depth_m);
      EXPECT_NEAR(a.force_N / b.force_N, 1.0, 1e-4) << depth_m;
      EXPECT_NEAR(a.stiffness_N_per_m / b.stiffness_N_per_m, 1.0, 1e-3) << depth_m;
      EXPECT_NEAR(a.energy_J / b.energy_J, 1.0, 1e-3) << depth_m;
    }
  }
}

TEST(SeriesLaw, SharesTheDepthAndStaysWhereTheTipEnds) {
  const Pair soft(0.03), held(-0.008);
  const double force_N = soft.series.respond(6_mm).force_N;
  EXPECT_NEAR(soft.tip.respond(6_mm - 0.03 * force_N).force_N, force_N, 1e-12);
  EXPECT_EQ(soft.series.range().press_m, 12_mm);
  const double end_m = held.series.range().press_m;
  EXPECT_NEAR(end_m, 12_mm - 0.008 * held.tip.respond(12_mm).force_N, 1e-12);
  EXPECT_NEAR(held.series.respond(20_mm).force_N, held.tip.respond(12_mm).force_N, 1e-12);
  EXPECT_EQ(held.series.respond(20_mm).status, LawStatus::kSaturated);
}

TEST(SeriesLaw, RefusesAPlaceThatIsStifferThanItsLaw) {
  const indent::ComplianceCurve tip = place(0.0);
  const double most_N_per_m = stiffest_N_per_m(tip, -12_mm, 12_mm);
  EXPECT_TRUE(make_series_law(tip, -0.99 / most_N_per_m, tip));
  for (const double compliance_m_per_N : {-1.01 / most_N_per_m, std::nan(""), HUGE_VAL}) {
    const auto refused = make_series_law(tip, compliance_m_per_N, tip);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("allowed: finite and above"), std::string::npos);
  }
}

}  // namespace tact::model::law::series_law_test
