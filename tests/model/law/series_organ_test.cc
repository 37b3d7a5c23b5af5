// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "model/indent/compliance_law.h"
#include "model/indent/hunt_crossley.h"
#include "model/law/series_law.h"
#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::law::series_organ_test {

indent::ComplianceCurve tip(double youngs_modulus_Pa = 5000.0) {
  auto curve = indent::make_compliance_curve(
      {.tip = {.youngs_modulus_Pa = youngs_modulus_Pa, .poisson_ratio = 0.45, .radius_m = 4_mm},
       .working_depth_m = 8_mm,
       .ring_pitch_m = 4_mm,
       .ring_m_per_N = std::array{0.0},
       .table_knots = 257});
  EXPECT_TRUE(curve) << curve.error().message;
  return *curve;
}

/// F = k y, both ways.
class Spring final : public Law {
 public:
  Spring(double stiffness_N_per_m, LawRange range) : k_(stiffness_N_per_m), range_(range) {}
  LawResponse respond(double d) const RT_SAFE override {
    if (!std::isfinite(d)) return {.status = LawStatus::kInvalid};
    const double y = std::clamp(d, range_.pull_m, range_.press_m);
    return beyond_limit({k_ * y, k_, 0.5 * k_ * y * y, LawStatus::kOk}, y, d);
  }
  LawRange range() const RT_SAFE override { return range_; }
  std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 1.0; }

 private:
  double k_;
  LawRange range_;
};

TEST(SeriesOrgan, KeepTheLawContract) {
  const indent::ComplianceCurve ball = tip();
  for (const double pull_m : {-20_mm, 0.0}) {
    const Spring organ(40.0, {pull_m, 20_mm});
    tests::check_law_contract(*make_series_law(ball, organ));
  }
}

// A spring of 1/r under the tip is the organ of SL-1: another implementation, of one law and r.
TEST(SeriesOrgan, ASpringIsTheComplianceOfItsPlace) {
  const indent::ComplianceCurve ball = tip();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 50; ++i) {
    const double r_m_per_N = 0.002 + 0.05 * share(random);
    const Spring organ(1.0 / r_m_per_N, {-1.0, 1.0});
    const SeriesLaw pair = *make_series_law(ball, organ);
    const SeriesLaw place = *make_series_law(ball, r_m_per_N, ball);
    const LawRange range = place.range();
    for (int j = 0; j < 40; ++j) {
      const double d = range.pull_m + share(random) * (range.press_m - range.pull_m);
      const LawResponse is = pair.respond(d), must = place.respond(d);
      ASSERT_NEAR(is.force_N, must.force_N, 1e-9) << d << " m, r " << r_m_per_N;
      ASSERT_NEAR(is.energy_J, must.energy_J, 1e-12);
      ASSERT_NEAR(is.stiffness_N_per_m, must.stiffness_N_per_m, 1e-3);
    }
  }
}

TEST(SeriesOrgan, EndWhereTheWeakerEnds) {
  const indent::ComplianceCurve ball = tip();
  const Spring weak(10.0, {-5_mm, 5_mm}), strong(1000.0, {-100_mm, 100_mm});
  const SeriesLaw on_weak = *make_series_law(ball, weak),
                  on_strong = *make_series_law(ball, strong);
  EXPECT_NEAR(on_weak.respond(1.0).force_N, 0.05, 1e-9);
  EXPECT_EQ(on_weak.respond(1.0).status, LawStatus::kSaturated);
  const double most_N = ball.respond(8_mm).force_N;
  EXPECT_NEAR(on_strong.range().press_m, 8_mm + most_N / 1000.0, 1e-9);
  EXPECT_NEAR(on_strong.respond(1.0).force_N, most_N, 1e-9);
  EXPECT_NEAR(on_weak.respond(-1.0).force_N, -0.05, 1e-9);
}

// Each damper sees the speed of its own share, so the pair loses what both lose.
TEST(SeriesOrgan, LoseWhatBothLose) {
  const indent::ComplianceCurve ball = tip();
  const indent::HuntCrossley organ = *indent::make_hunt_crossley(
      {.force_N = 0.5, .working_depth_m = 12_mm, .exponent = 1.4, .dissipation_s_per_m = 5.0});
  const SeriesLaw pair = *make_series_law(ball, organ);
  const double step_m = 1e-7;
  for (const double d : {1_mm, 3_mm, 6_mm}) {
    // y of both depths from the force alone, by the organ's own curve
    const auto organ_depth_m = [&](double depth_m) {
      const double force_N = pair.respond(depth_m).force_N;
      double low_m = 0.0, high_m = 12_mm;
      for (int i = 0; i < 60; ++i) {
        const double y_m = 0.5 * (low_m + high_m);
        (organ.respond(y_m).force_N < force_N ? low_m : high_m) = y_m;
      }
      return low_m;
    };
    const double share = (organ_depth_m(d + step_m) - organ_depth_m(d - step_m)) / (2.0 * step_m);
    const double lost = organ.damping_Ns_per_m(organ_depth_m(d)) * share * share;
    EXPECT_NEAR(pair.damping_Ns_per_m(d), lost, 1e-4 * lost);
    EXPECT_GT(lost, 0.0);
  }
}

TEST(SeriesOrgan, AForceThatFallsIsRefused) {
  class Falls final : public Law {
   public:
    LawResponse respond(double d) const RT_SAFE override { return {d * (8_mm - d)}; }
    LawRange range() const RT_SAFE override { return {0.0, 8_mm}; }
    std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
    double ring_pitch_m() const RT_SAFE override { return 1.0; }
  };
  const indent::ComplianceCurve ball = tip();
  const Falls organ;
  const auto pair = make_series_law(ball, organ);
  ASSERT_FALSE(pair);
  EXPECT_NE(pair.error().message.find("its force falls"), std::string::npos);
}

}  // namespace tact::model::law::series_organ_test
