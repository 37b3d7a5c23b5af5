// SPDX-License-Identifier: Apache-2.0
#include "tools/printed/hex_paper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::tools::printed::hex_paper_test {

using namespace model;
using namespace model::indent;

constexpr HexPaperParameters kPrinted{.ring_pitch_m = 2_mm,
                                      .body_stiffness_N_per_m = 50.0,
                                      .rings = 25,
                                      .weight = HexWeight::kRing,
                                      .working_depth_m = 10_mm};

HexPaper make(const HexPaperParameters& p) {
  auto paper = make_hex_paper(p);
  EXPECT_TRUE(paper) << paper.error().message;
  return *paper;
}

TEST(HexPaper, KeepsTheLawContract) {
  tests::check_law_contract(make(kPrinted));
  HexPaperParameters node = kPrinted;
  node.weight = HexWeight::kNode;
  node.rings = kMaxHexRings;
  tests::check_law_contract(make(node));
}

TEST(HexPaper, HasConsistentDimensions) {
  tests::check_dimensions([](double m, double kg, double s) -> std::unique_ptr<Law> {
    HexPaperParameters p = kPrinted;
    p.ring_pitch_m *= m;
    p.working_depth_m *= m;
    p.body_stiffness_N_per_m *= kg / (s * s);
    return std::make_unique<HexPaper>(make(p));
  });
}

TEST(HexPaper, OneRingIsPenAndPaper) {
  // r = 3 mm, d = 4 mm: the spring is 5 mm long, eps_1 = 2/3; only the contact node moves, F = K_N
  // d
  const PaperShape at = paper_shape_at_depth(3_mm, 1, 4_mm);
  EXPECT_NEAR(at.first_strain, 2.0 / 3.0, 1e-14);
  EXPECT_NEAR(paper_force_N(at, 50.0, HexWeight::kNode), 0.2, 1e-15);
}

TEST(HexPaper, ObeysThePrintedEquations) {
  const double r = 2_mm;
  const PaperShape at = paper_shape_at_depth(r, 25, 5_mm);
  const double c = at.first_strain / (1.0 + at.first_strain);
  double sum_m = 0.0;
  for (std::size_t i = 0; i < 25; ++i) {
    const double alpha = 2.0 * static_cast<double>(i) + 1.0, eps = at.strain[i];
    EXPECT_NEAR(alpha * eps / (1.0 + eps), c, 1e-14);                                    // HX-10
    EXPECT_NEAR(at.drop_m[i], std::sqrt((r + eps * r) * (r + eps * r) - r * r), 1e-15);  // HX-7
    sum_m += at.drop_m[i];
    EXPECT_NEAR(at.ring_m[i] - at.ring_m[i + 1], at.drop_m[i], 1e-17);  // HX-6
  }
  EXPECT_NEAR(sum_m, 5_mm, 1e-16);
  EXPECT_EQ(at.ring_m[25], 0.0);
}

TEST(HexPaper, DepthAndStrainInvertEachOther) {
  for (const std::size_t rings : {1u, 2u, 10u, 25u, 64u}) {
    for (const double strain : {0.0, 1e-18, 1e-6, 0.01, 0.5, 3.0, 500.0}) {
      const PaperShape shape = paper_shape_at_strain(2_mm, rings, strain);
      const PaperShape back = paper_shape_at_depth(2_mm, rings, shape.ring_m[0]);
      EXPECT_NEAR(back.first_strain, strain, 1e-12 * strain) << rings << " rings";
    }
  }
}

TEST(HexPaper, TheLawIsTheTableOfThePrintedForce) {
  for (const HexWeight weight : {HexWeight::kRing, HexWeight::kNode}) {
    HexPaperParameters p = kPrinted;
    p.weight = weight;
    const HexPaper paper = make(p);
    const double largest_N = paper.respond(10_mm).force_N;
    for (double d = 0.013_mm; d < 10_mm; d += 0.091_mm) {
      const double printed_N = paper_force_N(paper_shape_at_depth(2_mm, 25, d), 50.0, weight);
      EXPECT_NEAR(paper.respond(d).force_N, printed_N, 1e-10 * largest_N);
    }
  }
  // HX-12: 2.323 N at 5 mm, 4.506 N at 10 mm
  EXPECT_NEAR(make(kPrinted).respond(5_mm).force_N, 2.323, 5e-4);
  EXPECT_NEAR(make(kPrinted).respond(10_mm).force_N, 4.506, 5e-4);
}

TEST(HexPaper, BeyondTheWorkingDepthTheForceStays) {
  const HexPaper paper = make(kPrinted);
  const LawResponse at = paper.respond(10_mm), beyond = paper.respond(-12_mm);
  EXPECT_EQ(beyond.status, LawStatus::kSaturated);
  EXPECT_EQ(beyond.force_N, -at.force_N);
  EXPECT_NEAR(beyond.energy_J - at.energy_J, at.force_N * 2e-3, 1e-14);
}

TEST(HexPaper, RimSlopeAsksForANumberOfRings) {
  // The exact inversion of HX-9: the rim slope of m rings asks for m rings
  for (const std::size_t rings : {2u, 7u, 25u, 60u}) {
    const PaperShape at = paper_shape_at_strain(2_mm, rings, 0.1);
    EXPECT_NEAR(paper_rings(0.1, at.boundary_slope).exact, static_cast<double>(rings), 1e-9);
  }
  // HX-13: eps_1 = 0.1 with l_m/r = 0.061 is m = 25
  EXPECT_EQ(paper_rings(0.1, 0.061).rings, 25u);
  EXPECT_EQ(paper_rings(0.01, 2.0).rings, 1u);
  EXPECT_EQ(paper_rings(0.01, 2.0).status, LawStatus::kSaturated);
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(paper_rings(bad, 0.1).status, LawStatus::kInvalid);
    EXPECT_EQ(paper_rings(0.1, bad).status, LawStatus::kInvalid);
  }
}

TEST(HexPaper, HasNoShapeForInputWithoutMeaning) {
  EXPECT_EQ(paper_shape_at_depth(2_mm, 0, 1_mm).rings, 0u);
  EXPECT_EQ(paper_shape_at_depth(2_mm, kMaxPaperRings + 1, 1_mm).rings, 0u);
  EXPECT_EQ(paper_shape_at_depth(2_mm, 25, std::nan("")).rings, 0u);
  EXPECT_EQ(paper_shape_at_strain(2_mm, 25, -0.1).rings, 0u);
  EXPECT_EQ(paper_shape_at_strain(0.0, 25, 0.1).rings, 0u);
}

TEST(HexPaper, RefusesParametersWithoutMeaning) {
  const auto refused = [](auto change) {
    HexPaperParameters p = kPrinted;
    change(p);
    return !make_hex_paper(p);
  };
  EXPECT_TRUE(refused([](auto& p) { p.ring_pitch_m = -1.0; }));
  EXPECT_TRUE(refused([](auto& p) { p.body_stiffness_N_per_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& p) { p.rings = 0; }));
  EXPECT_TRUE(refused([](auto& p) { p.rings = kMaxHexRings + 1; }));
  EXPECT_TRUE(refused([](auto& p) { p.working_depth_m = std::nan(""); }));
}

}  // namespace tact::tools::printed::hex_paper_test
