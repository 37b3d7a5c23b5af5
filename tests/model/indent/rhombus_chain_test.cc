// SPDX-License-Identifier: Apache-2.0
#include "model/indent/rhombus_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::indent::rhombus_chain_test {

// The defaults of RC-13.
constexpr RhombusChainParameters kLiver{.rod_length_m = 10_mm,
                                        .initial_angle_rad = 30_deg,
                                        .normal_stiffness_N_per_m = 1500.0,
                                        .tangential_stiffness_N_per_m = 1800.0,
                                        .growth = 2.0,
                                        .units = 10};

RhombusChain make(const RhombusChainParameters& p) {
  auto chain = make_rhombus_chain(p);
  EXPECT_TRUE(chain) << chain.error().message;
  return *chain;
}

TEST(RhombusChain, KeepsTheLawContract) { tests::check_law_contract(make(kLiver)); }

TEST(RhombusChain, KeepsTheLawContractWhenItsUnitsSnap) {
  RhombusChainParameters p = kLiver;
  p.initial_angle_rad = 45_deg;
  p.tangential_stiffness_N_per_m = 60000.0;
  const RhombusChain chain = make(p);
  EXPECT_EQ(chain.limit_kind(), UnitLimit::kSnap);
  tests::check_law_contract(chain);
}

TEST(RhombusChain, HasConsistentDimensions) {
  tests::check_dimensions([](double m, double kg, double s) -> std::unique_ptr<law::Law> {
    RhombusChainParameters p = kLiver;
    p.rod_length_m *= m;
    p.normal_stiffness_N_per_m *= kg / (s * s);
    p.tangential_stiffness_N_per_m *= kg / (s * s);
    return std::make_unique<RhombusChain>(make(p));
  });
}

TEST(RhombusChain, MatchesPenAndPaperAtSmallStrain) {
  // One unit: kN + kT tan^2(30 deg) = 1500 + 1800 / 3 = 2100 N/m.
  RhombusChainParameters p = kLiver;
  p.units = 1;
  EXPECT_NEAR(make(p).respond(1e-9).stiffness_N_per_m, 2100.0, 1e-3);
  // Ten units: RC-13 says 530 N/m at rest, 15 N and 51.3 mm at the limit.
  const RhombusChain chain = make(kLiver);
  EXPECT_NEAR(chain.respond(0.0).stiffness_N_per_m, 530.0, 0.5);
  EXPECT_NEAR(chain.force_limit_N(), 15.0, 1e-9);
  EXPECT_NEAR(chain.range().press_m, 51.3_mm, 0.05_mm);
}

TEST(RhombusChain, WithoutTangentialSpringsIsSpringsInSeries) {
  RhombusChainParameters p = kLiver;
  p.tangential_stiffness_N_per_m = 0.0;
  const RhombusChain chain = make(p);
  for (const double d : {1_mm, 10_mm, 50_mm})
    EXPECT_NEAR(chain.respond(d).force_N, 1500.0 / 10.0 * d, 1e-9);
}

TEST(RhombusChain, DepthAndForceInvertEachOther) {
  const RhombusChain chain = make(kLiver);
  for (const double force_N : {-30.0, -3.0, -1e-6, 1e-6, 0.3, 7.0, 14.99}) {
    const double depth_m = chain.at_force(force_N).depth_m;
    EXPECT_NEAR(chain.at_depth(depth_m).force_N, force_N, 1e-9 * std::abs(force_N));
  }
}

TEST(RhombusChain, HardensWhenPulled) {
  const RhombusChain chain = make(kLiver);
  EXPECT_GT(chain.respond(-5_mm).stiffness_N_per_m, 1.2 * chain.respond(5_mm).stiffness_N_per_m);
  EXPECT_LT(chain.respond(-5_mm).force_N, 0.0);
}

TEST(RhombusChain, RefusesParametersWithoutMeaning) {
  const auto refused = [](auto change) {
    RhombusChainParameters p = kLiver;
    change(p);
    return !make_rhombus_chain(p);
  };
  EXPECT_TRUE(refused([](auto& p) { p.rod_length_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& p) { p.initial_angle_rad = std::numbers::pi / 2; }));
  EXPECT_TRUE(refused([](auto& p) { p.normal_stiffness_N_per_m = std::nan(""); }));
  EXPECT_TRUE(refused([](auto& p) { p.tangential_stiffness_N_per_m = -1.0; }));
  EXPECT_TRUE(refused([](auto& p) { p.growth = 0.0; }));
  EXPECT_TRUE(refused([](auto& p) { p.units = 0; }));
  EXPECT_TRUE(refused([](auto& p) { p.growth = 0.01; }));  // exp(900) overflows
}

}  // namespace tact::model::indent::rhombus_chain_test
