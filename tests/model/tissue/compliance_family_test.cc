// SPDX-License-Identifier: Apache-2.0
#include "model/tissue/compliance_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/units.h"

namespace tact::model::tissue::compliance_family_test {

constexpr ComplianceFamilyParameters kLiver{
    .youngs_modulus_Pa = 5000.0, .tip_radius_m = 4_mm, .working_depth_m = 10_mm};

// 200 places from the held side to the tip of a thin lobe, r E in 1/m.
ComplianceMap lobe() {
  ComplianceMap map{.poisson_ratio = 0.45,
                    .patch_radius_m = 8_mm,
                    .ring_pitch_m = 2_mm,
                    .rings = 20,
                    .mesh_hash = "0123456789abcdef"};
  for (int v = 0; v < 200; ++v) {
    const auto r = static_cast<float>(-90.0 + v);
    map.regular_times_E_per_m.push_back(r);
    map.sideways_times_E_per_m.push_back({.n1 = 0.3F * r, .n2 = 0.0F, .s1 = 40.0F, .s2 = 10.0F});
    for (std::size_t j = 1; j <= map.rings; ++j)
      map.ring_times_E_per_m.push_back(r * (1.0F - 0.02F * static_cast<float>(j)));
  }
  return map;
}

ComplianceFamily make(const ComplianceMap& map, ComplianceFamilyParameters p = kLiver) {
  auto family = make_compliance_family(map, p);
  EXPECT_TRUE(family) << family.error().message;
  return std::move(*family);
}

/// The field's blend: energies, and so forces, linear between neighbours.
double blended_N(const ComplianceFamily& family, double kappa, double depth_m) {
  const auto low = std::min(static_cast<std::size_t>(kappa), family.curve.size() - 2);
  const double f = kappa - static_cast<double>(low);
  return (1.0 - f) * family.curve[low].respond(depth_m).force_N +
         f * family.curve[low + 1].respond(depth_m).force_N;
}

TEST(ComplianceFamily, IsSortedFromSoftToStiff) {
  const ComplianceFamily family = make(lobe());
  ASSERT_EQ(family.curve.size(), 17u);
  for (std::size_t k = 1; k < 17; ++k)
    for (const double d : {-5_mm, 1_mm, 9_mm})
      EXPECT_GT(std::abs(family.curve[k].respond(d).force_N),
                std::abs(family.curve[k - 1].respond(d).force_N));
  EXPECT_TRUE(std::is_sorted(family.press_coordinate.rbegin(), family.press_coordinate.rend()));
  for (const float kappa : family.pull_coordinate) {
    EXPECT_GE(kappa, 0.0F);
    EXPECT_LE(kappa, 16.0F);
  }
}

TEST(ComplianceFamily, TheBlendIsTheLawOfThePlaceWithinHalfAPercent) {
  const ComplianceMap map = lobe();
  const std::vector<double> flat(20, 0.0);
  const ComplianceFamily family = make(map);
  for (std::size_t v = 40; v < 200; v += 7) {
    const double r = static_cast<double>(map.regular_times_E_per_m[v]) / 5000.0;
    const auto own = indent::make_compliance_curve({.tip = {5000.0, 0.45, 4_mm},
                                                    .regular_m_per_N = r,
                                                    .working_depth_m = 10_mm,
                                                    .ring_pitch_m = 2_mm,
                                                    .ring_m_per_N = flat});
    ASSERT_TRUE(own);
    for (const double d : {-9_mm, 0.5_mm, 2_mm, 5_mm, 9.9_mm}) {
      const double kappa = static_cast<double>(family.press_coordinate[v]);
      EXPECT_NEAR(blended_N(family, kappa, d) / own->respond(d).force_N, 1.0, 0.005)
          << "vertex " << v << " depth " << d;
    }
  }
}

TEST(ComplianceFamily, APullThatMayNotMoveSidewaysIsStiffer) {
  // Vertex 190: r E = 100, n1 E = 30, s1 E = 40 1/m; c_side E = 1.55 2.9 / (8 0.004 m) = 140.469
  // 1/m; CF-3: r_pull E = 100 - 30^2 / (140.469 + 40) = 95.0130 1/m
  const ComplianceMap map = lobe();
  const ComplianceFamily family = make(map);
  const indent::ElasticTip tip{5000.0, 0.45, 4_mm};
  const double expected = 1.0 / (1.0 / tip.pulled_stiffness_N_per_m() + 95.0130 / 5000.0);
  const double kappa = static_cast<double>(family.pull_coordinate[190]);
  EXPECT_NEAR(blended_N(family, kappa, -1_mm) / (-1_mm * expected), 1.0, 0.003);
  EXPECT_GT(family.pull_coordinate[190], family.press_coordinate[190]);
}

TEST(ComplianceFamily, AHeldPatchIsStifferSidewaysThanOneThatMaySink) {
  // Vertex 190 again, axis 1 along y, 2 along -x: S E = diag(10, 40), 1/m; c_disc as in CF-1;
  // CF-4: S_held E = S E - diag(0, 30^2) / (c_disc E + 100)
  const indent::ElasticTip tip{1.0, 0.45, 4_mm};
  const double disc = 1.0 / tip.pulled_stiffness_N_per_m();
  ComplianceMap map = lobe();
  map.sideways_times_E_per_m[190].axis = {0.0F, 1.0F, 0.0F};
  const std::vector<Vec3> up(200, Vec3{0.0, 0.0, 1.0});
  const TangentTensors give = tangent_compliance(map, up, 4_mm).at(190);
  EXPECT_EQ(give.contact_per_m, (std::array{10.0F, 40.0F, 0.0F, 0.0F, 0.0F, 0.0F}));
  EXPECT_NEAR(give.held_per_m[0], 10.0, 1e-4);
  EXPECT_NEAR(give.held_per_m[1], 40.0 - 900.0 / (disc + 100.0), 1e-4);
}

TEST(ComplianceFamily, TangentStiffnessIsAtMostThreeTimesThatOfAHalfSpace) {
  const indent::ElasticTip tip{1.0, 0.45, 4_mm};
  const double half_space = 1.0 / tip.sideways_stiffness_N_per_m();
  ComplianceMap map = lobe();
  map.sideways_times_E_per_m[7] = {.n1 = 500.0F, .n2 = 90.0F, .s1 = -1e4F, .s2 = 5.0F};
  const std::vector<Vec3> up(200, Vec3{0.0, 0.0, 1.0});
  const TangentTensors give = tangent_compliance(map, up, 4_mm).at(7);
  for (const std::array<float, 6>& s : {give.contact_per_m, give.held_per_m}) {
    const contact::Tensor2 whole{half_space + static_cast<double>(s[0]), static_cast<double>(s[5]),
                                 half_space + static_cast<double>(s[1])};
    EXPECT_GE(whole.least_eigenvalue(), half_space / contact::kMaxStiffness_ratio - 1e-4);
  }
}

TEST(ComplianceFamily, ForcesScaleWithYoungsModulus) {
  ComplianceFamilyParameters harder = kLiver;
  harder.youngs_modulus_Pa *= 2.4;
  const ComplianceFamily a = make(lobe()), b = make(lobe(), harder);
  for (std::size_t k = 0; k < 17; k += 4)
    EXPECT_NEAR(b.curve[k].respond(3_mm).force_N / a.curve[k].respond(3_mm).force_N, 2.4, 1e-9);
  for (std::size_t v = 0; v < 200; v += 9)
    EXPECT_NEAR(a.press_coordinate[v], b.press_coordinate[v], 1e-4F);
}

TEST(ComplianceFamily, TheHeldSideIsLimitedAndCounted) {
  ComplianceMap map = lobe();
  const std::size_t limited = make(map).limited_vertices;
  EXPECT_GT(limited, 5u);
  EXPECT_LT(limited, 60u);
  const ComplianceFamily family = make(map);
  const std::vector<double> flat(20, 0.0);
  const auto half_space = indent::make_compliance_curve({.tip = {5000.0, 0.45, 4_mm},
                                                         .regular_m_per_N = 0.0,
                                                         .working_depth_m = 10_mm,
                                                         .ring_pitch_m = 2_mm,
                                                         .ring_m_per_N = flat});
  ASSERT_TRUE(half_space);
  EXPECT_LE(family.curve.back().respond(9_mm).force_N / half_space->respond(9_mm).force_N,
            contact::kMaxStiffness_ratio);
}

TEST(ComplianceFamily, AnOrganThatIsTheSameEverywhereWorksToo) {
  ComplianceMap map = lobe();
  std::fill(map.regular_times_E_per_m.begin(), map.regular_times_E_per_m.end(), 0.0F);
  std::fill(map.sideways_times_E_per_m.begin(), map.sideways_times_E_per_m.end(),
            SidewaysCompliance{});
  const ComplianceFamily family = make(map);
  const double a_N = family.curve.front().respond(5_mm).force_N;
  EXPECT_NEAR(family.curve.back().respond(5_mm).force_N / a_N, 1.0, 1e-6);
}

TEST(ComplianceFamily, StatesItsMemoryAndKeepsItSmall) {
  const std::size_t bytes = make(lobe()).memory_bytes();
  EXPECT_GT(bytes, 17u * 64u * 40u);
  EXPECT_LT(bytes, 1u << 20U);
}

TEST(ComplianceFamily, RefusesParametersWithoutMeaning) {
  const auto refused = [](auto change) {
    ComplianceFamilyParameters p = kLiver;
    change(p);
    return !make_compliance_family(lobe(), p);
  };
  EXPECT_TRUE(refused([](auto& p) { p.curves = 1; }));
  EXPECT_TRUE(refused([](auto& p) { p.curves = 66; }));
  EXPECT_TRUE(refused([](auto& p) { p.youngs_modulus_Pa = 0.0; }));
  EXPECT_TRUE(refused([](auto& p) { p.tip_radius_m = std::nan(""); }));
  EXPECT_TRUE(refused([](auto& p) { p.working_depth_m = -1.0; }));
  EXPECT_FALSE(make_compliance_family(ComplianceMap{}, kLiver));
}

}  // namespace tact::model::tissue::compliance_family_test
