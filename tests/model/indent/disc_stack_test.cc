// SPDX-License-Identifier: Apache-2.0
#include "model/indent/disc_stack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::indent::disc_stack_test {

constexpr Disc kSoft{
    .outer_diameter_m = 10_mm, .stiffness_N_per_m = 500.0, .travel_m = 0.9_mm, .cone_ratio = 0.4};
constexpr LayerDelays kPrintedDelays{
    .first_delay_s = 10_us, .delay_ratio = 1.1, .refresh_rate_Hz = 1100.0, .layers = 64};

DiscStack make(DiscForm form, const Disc& disc = kSoft,
               const LayerDelays& delays = kPrintedDelays) {
  auto stack = make_disc_stack(disc, form, delays);
  EXPECT_TRUE(stack) << stack.error().message;
  return *stack;
}

TEST(DiscStack, KeepsTheLawContract) {
  tests::check_law_contract(make(DiscForm::kAlmenLaszlo));
  tests::check_law_contract(make(DiscForm::kLinear));
}

TEST(DiscStack, KeepsTheLawContractAtTheEdgeOfSnapping) {
  Disc disc = kSoft;
  disc.cone_ratio = 1.414;
  tests::check_law_contract(make(DiscForm::kAlmenLaszlo, disc));
}

TEST(DiscStack, HasConsistentDimensions) {
  tests::check_dimensions([](double m, double kg, double s) -> std::unique_ptr<law::Law> {
    Disc disc = kSoft;
    disc.outer_diameter_m *= m;
    disc.travel_m *= m;
    disc.stiffness_N_per_m *= kg / (s * s);
    LayerDelays delays = kPrintedDelays;
    delays.first_delay_s *= s;
    delays.refresh_rate_Hz /= s;
    return std::make_unique<DiscStack>(make(DiscForm::kAlmenLaszlo, disc, delays));
  });
}

TEST(DiscStack, MatchesPenAndPaper) {
  // Linear: 500 N/m * 5 mm = 2.5 N, 3.125e-3 * 2 J; ceil(5 / 0.9) = 6 layers move.
  const DiscStackState linear = make(DiscForm::kLinear).at_depth(5_mm);
  EXPECT_NEAR(linear.force_N, 2.5, 1e-12);
  EXPECT_NEAR(linear.energy_J, 6.25e-3, 1e-15);
  EXPECT_EQ(linear.moving_layers, 6u);
  // Almen-Laszlo: 5 flat layers carry 2.25 N, the sixth is at x = 5/9:
  // 0.25 N (1 + 0.16 * 4/9 * 13/18) = 0.25 N * 1.0513580
  EXPECT_NEAR(make(DiscForm::kAlmenLaszlo).at_depth(5_mm).force_N, 2.25 + 0.25 * 1.05135802, 1e-8);
}

TEST(DiscStack, DelaysAreAGeometricSeries) {
  // 10 us (1 + 1.1 + 1.21 + 1.331) = 46.41 us
  EXPECT_NEAR(delay_through_layer_s(kPrintedDelays, 4), 46.41e-6, 1e-17);
  EXPECT_EQ(delay_through_layer_s(kPrintedDelays, 0), 0.0);
  LayerDelays equal = kPrintedDelays;
  equal.delay_ratio = 1.0;
  EXPECT_NEAR(delay_through_layer_s(equal, 50), 500e-6, 1e-15);
}

TEST(DiscStack, TimeBudgetOrLayerCapEndsTheStackAndItSaysWhich) {
  EXPECT_EQ(make(DiscForm::kLinear).layer_count(), 24u);
  EXPECT_EQ(make(DiscForm::kLinear).truncated_by(), TruncatedBy::kTimeBudget);
  LayerDelays few = kPrintedDelays;
  few.layers = 8;
  EXPECT_EQ(make(DiscForm::kLinear, kSoft, few).layer_count(), 8u);
  EXPECT_EQ(make(DiscForm::kLinear, kSoft, few).truncated_by(), TruncatedBy::kLayerCap);
  LayerDelays shrinking = kPrintedDelays;  // T_i stays below t1 / (1 - q) = 20 us
  shrinking.delay_ratio = 0.5;
  EXPECT_EQ(make(DiscForm::kLinear, kSoft, shrinking).layer_count(), kMaxLayers);
  EXPECT_EQ(make(DiscForm::kLinear, kSoft, shrinking).truncated_by(), TruncatedBy::kLayerCap);
}

TEST(DiscStack, BeyondItsLayersTheForceStaysAndTheEnergyGoesOn) {
  const DiscStack stack = make(DiscForm::kAlmenLaszlo);
  const double limit_m = stack.range().press_m, limit_N = 24 * 500.0 * 0.9e-3;
  EXPECT_NEAR(stack.force_limit_N(), limit_N, 1e-12);
  const law::LawResponse at = stack.respond(limit_m), beyond = stack.respond(limit_m + 1_mm);
  EXPECT_EQ(at.status, law::LawStatus::kOk);
  EXPECT_NEAR(at.force_N, limit_N, 1e-12);
  EXPECT_EQ(beyond.status, law::LawStatus::kSaturated);
  EXPECT_NEAR(beyond.force_N, limit_N, 1e-12);
  EXPECT_EQ(beyond.stiffness_N_per_m, 0.0);
  EXPECT_NEAR(beyond.energy_J - at.energy_J, limit_N * 1e-3, 1e-14);
}

TEST(DiscStack, DepthAndForceInvertEachOther) {
  for (const DiscForm form : {DiscForm::kLinear, DiscForm::kAlmenLaszlo}) {
    const DiscStack stack = make(form);
    const tests::NoAlloc guard;
    for (const double force_N : {1e-9, 0.1, 0.449, 0.451, 3.3, 10.7}) {
      const DiscStackState at = stack.at_force(force_N);
      EXPECT_NEAR(stack.at_depth(at.depth_m).force_N, force_N, 1e-12);
      EXPECT_EQ(at.moving_layers, static_cast<std::size_t>(std::ceil(force_N / 0.45)));
    }
    EXPECT_EQ(guard.calls(), 0u);
  }
}

TEST(DiscStack, ForceBeyondTheStackIsReportedAsUnsupported) {
  const DiscStackState over = make(DiscForm::kLinear).at_force(20.0);
  EXPECT_EQ(over.status, law::LawStatus::kSaturated);
  EXPECT_NEAR(over.force_N + over.unsupported_force_N, 20.0, 1e-12);
  EXPECT_NEAR(over.depth_m, 24 * 0.9e-3, 1e-15);
  EXPECT_EQ(make(DiscForm::kLinear).at_force(-1.0).status, law::LawStatus::kNoContact);
  EXPECT_EQ(make(DiscForm::kLinear).at_force(std::nan("")).status, law::LawStatus::kInvalid);
}

TEST(DiscStack, AForceOfWholeLayersNeedsNoFurtherLayer) {
  // Binary-exact numbers: 1024 N/m * 2^-10 m = 1 N a layer.
  Disc disc = kSoft;
  disc.stiffness_N_per_m = 1024.0;
  disc.travel_m = 1.0 / 1024.0;
  const DiscStack stack = make(DiscForm::kAlmenLaszlo, disc);
  EXPECT_EQ(stack.at_force(3.0).moving_layers, 3u);
  EXPECT_EQ(stack.at_force(3.0).last_flattening_m, disc.travel_m);
  EXPECT_EQ(stack.at_force(std::nextafter(3.0, 4.0)).moving_layers, 4u);
  EXPECT_EQ(stack.at_depth(3.0 / 1024.0).moving_layers, 3u);
}

TEST(DiscStack, ProfileLosesOneFlatLayerARing) {
  std::vector<double> ring_m(64);
  ASSERT_EQ(make(DiscForm::kLinear).profile(2_mm, ring_m), 25u);
  EXPECT_NEAR(ring_m[0], 2_mm, 1e-15);
  EXPECT_NEAR(ring_m[1], 1.1_mm, 1e-15);
  EXPECT_NEAR(ring_m[2], 0.2_mm, 1e-15);
  EXPECT_EQ(ring_m[3], 0.0);
  std::vector<double> few_m(2);
  EXPECT_EQ(make(DiscForm::kLinear).profile(2_mm, few_m), 2u);
}

TEST(DiscStack, RefusesParametersWithoutMeaningAndSaysWhy) {
  const auto complaint = [](const Disc& disc, DiscForm form, auto change) {
    LayerDelays delays = kPrintedDelays;
    change(delays);
    const auto stack = make_disc_stack(disc, form, delays);
    return stack ? std::string() : stack.error().message;
  };
  const auto same = [](auto&) {};
  Disc snapping = kSoft;
  snapping.cone_ratio = 1.6;
  EXPECT_NE(complaint(snapping, DiscForm::kAlmenLaszlo, same).find("snaps through"),
            std::string::npos);
  EXPECT_EQ(complaint(snapping, DiscForm::kLinear, same), "") << "the linear form has no cone";
  const auto delays_refused = [&](auto change) {
    return !complaint(kSoft, DiscForm::kLinear, change).empty();
  };
  EXPECT_NE(complaint(kSoft, DiscForm::kLinear, [](auto& p) { p.first_delay_s = 1_ms; })
                .find("no layer may move"),
            std::string::npos);
  EXPECT_TRUE(delays_refused([](auto& p) { p.first_delay_s = 0.0; }));
  EXPECT_TRUE(delays_refused([](auto& p) { p.delay_ratio = -1.0; }));
  EXPECT_TRUE(delays_refused([](auto& p) { p.refresh_rate_Hz = 0.0; }));
  EXPECT_TRUE(delays_refused([](auto& p) { p.layers = 0; }));
  EXPECT_TRUE(delays_refused([](auto& p) { p.layers = 65; }));
  Disc bad = kSoft;
  bad.stiffness_N_per_m = std::numeric_limits<double>::infinity();
  EXPECT_NE(complaint(bad, DiscForm::kLinear, same), "");
  EXPECT_FALSE(make_disc_stack(DiscStackParameters{}));
}

}  // namespace tact::model::indent::disc_stack_test
