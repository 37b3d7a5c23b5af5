#include "model/compliance_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/tabulated_law.h"
#include "model/units.h"
#include "tests/law_contract.h"

namespace tact::model {
namespace {

// 5 kPa under a 4 mm tip at a place that bends like a thin lobe; g_j falls outwards.
struct Place {
  double youngs_modulus_Pa = 5000.0;
  double regular_m_per_N = 0.008;
  double radius_m = 4_mm, working_depth_m = 10_mm, ring_pitch_m = 2_mm;
};

std::vector<double> rings_of(const Place& p) {
  std::vector<double> g;
  for (int j = 1; j <= 20; ++j) g.push_back(p.regular_m_per_N * (1.0 - 0.02 * j));
  return g;
}

Result<ComplianceCurve> try_make(const Place& p, double poisson_ratio = 0.45) {
  const std::vector<double> rings = rings_of(p);
  return make_compliance_curve({.tip = {p.youngs_modulus_Pa, poisson_ratio, p.radius_m},
                                .regular_m_per_N = p.regular_m_per_N,
                                .working_depth_m = p.working_depth_m,
                                .ring_pitch_m = p.ring_pitch_m,
                                .ring_m_per_N = rings});
}

ComplianceCurve make(const Place& p, double poisson_ratio = 0.45) {
  auto curve = try_make(p, poisson_ratio);
  EXPECT_TRUE(curve) << curve.error().sentence;
  return *curve;
}

TEST(ComplianceLaw, KeepsTheLawContract) { tests::check_law_contract(make({})); }

TEST(ComplianceLaw, KeepsTheLawContractNearTheHeldSide) {
  tests::check_law_contract(make({.regular_m_per_N = -0.012}));
}

TEST(ComplianceLaw, HasConsistentDimensions) {
  tests::check_dimensions([](double m, double kg, double s) -> std::unique_ptr<Law> {
    const Place p;
    return std::make_unique<ComplianceCurve>(
        make({.youngs_modulus_Pa = p.youngs_modulus_Pa * kg / (m * s * s),
              .regular_m_per_N = p.regular_m_per_N * s * s / kg,
              .radius_m = p.radius_m * m,
              .working_depth_m = p.working_depth_m * m,
              .ring_pitch_m = p.ring_pitch_m * m}));
  });
}

// Block of radius and height 50 mm, E = 1 kPa (REFERENCE): r comes from a flat punch of 5 mm by
// CalculiX, the forces of a sphere of 5 mm from FEniCS. One number explains the whole block.
TEST(ComplianceLaw, OneNumberOfAFlatPunchPredictsTheSphere) {
  struct Block {
    double poisson_ratio, punch_N_per_m, at_1mm_N, at_5mm_N;
  };
  for (const Block& b : {Block{0.30, 11.929815, 3.323831e-3, 35.293633e-3},
                         Block{0.45, 13.687540, 3.801367e-3, 40.454634e-3},
                         Block{0.49, 14.401462, 3.993316e-3, 42.537712e-3}}) {
    const ElasticTip tip{1000.0, b.poisson_ratio, 5_mm};
    const double r = 1.0 / b.punch_N_per_m - 1.0 / (2.0 * tip.contact_modulus_Pa() * 5_mm);
    const ComplianceCurve curve = make(
        {.youngs_modulus_Pa = 1000.0, .regular_m_per_N = r, .radius_m = 5_mm}, b.poisson_ratio);
    EXPECT_NEAR(curve.respond(1_mm).force_N / b.at_1mm_N, 1.0, 0.001);
    EXPECT_NEAR(curve.respond(5_mm).force_N / b.at_5mm_N, 1.0, 0.001);
  }
}

TEST(ComplianceLaw, IsTwoSpringsInSeries) {
  const ComplianceCurve curve = make({});
  for (const double d : {0.01_mm, 0.5_mm, 3_mm, 9.9_mm}) {
    const TipState at = curve.exact(d);
    EXPECT_NEAR(at.depth_m + 0.008 * at.force_N, d, 1e-15);
  }
  // Pull: 4 G R ln(1.2) / 0.1 = 4 1724.138 0.004 1.8232156 = 50.2957 N/m; 1 / (1/50.2957 + 0.008)
  EXPECT_NEAR(curve.respond(-1_mm).force_N, -1e-3 / (1.0 / 50.2957 + 0.008), 1e-7);
}

TEST(ComplianceLaw, TheTableFollowsTheEquationWithinAThousandth) {
  const ComplianceCurve curve = make({});
  const double peak_N = curve.exact(10_mm).force_N;
  double worst = 0.0;
  for (int i = 0; i <= 5000; ++i) {
    const double d = 2e-6 * i;
    worst = std::max(worst, std::abs(curve.respond(d).force_N - curve.exact(d).force_N) / peak_N);
  }
  EXPECT_LT(worst, 3e-4);
  EXPECT_GT(worst, 3e-5) << "d^1.5 at first touch is no cubic";
}

TEST(ComplianceLaw, HardensInPressAndIsLinearInPull) {
  const ComplianceCurve curve = make({});
  EXPECT_GT(curve.respond(8_mm).stiffness_N_per_m, 1.5 * curve.respond(1_mm).stiffness_N_per_m);
  EXPECT_NEAR(curve.respond(-8_mm).force_N / curve.respond(-1_mm).force_N, 8.0, 1e-12);
}

TEST(ComplianceLaw, APlaceThatBendsCarriesItsSurroundings) {
  // 10 mm beside the tip a lobe follows much further than a half-space.
  std::array<double, 21> lobe{}, flat{};
  make({}).profile(5_mm, lobe);
  make({.regular_m_per_N = 0.0}).profile(5_mm, flat);
  EXPECT_GT(lobe[5], 1.2 * flat[5]);
}

TEST(ComplianceLaw, RefusesParametersWithoutMeaning) {
  EXPECT_FALSE(try_make({.youngs_modulus_Pa = 0.0}));
  EXPECT_FALSE(try_make({.regular_m_per_N = std::nan("")}));
  EXPECT_FALSE(try_make({.radius_m = -1.0}));
  EXPECT_FALSE(try_make({.working_depth_m = 0.0}));
  EXPECT_FALSE(try_make({.ring_pitch_m = 0.0}));
  EXPECT_FALSE(try_make({}, 0.6));
  const auto held = try_make({.regular_m_per_N = -0.02});  // 1 / (2 E* R) = 0.0199 m/N
  ASSERT_FALSE(held);
  EXPECT_NE(held.error().sentence.find("held side"), std::string::npos);
}

}  // namespace
}  // namespace tact::model
