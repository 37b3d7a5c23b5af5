// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/indent/disc_stack.h"
#include "model/indent/hex_sheet.h"
#include "model/indent/hunt_crossley.h"
#include "model/indent/rhombus_patch.h"
#include "model/springs/spring_patch.h"
#include "tests/tools/fit/fit_fixture.h"

namespace tact::tools::fit::fit_run_test {

/// Errors of 1 % of the peak that look like noise and are always the same.
void spoil(FitData& data) {
  const double peak_N = data.peak_N();
  unsigned state = 1;
  for (FitSite& site : data.sites)
    for (FitSample& s : site.samples) {
      state = state * 1664525U + 1013904223U;
      s.force_N += 0.01 * peak_N * 1.73 * (static_cast<double>(state >> 8) / 8388608.0 - 1.0);
    }
}

TEST(FitRun, FindsTheRhombusChainThatMadeTheData) {
  Scene truth = make_scene();
  truth.laws.of<model::indent::RhombusParameters>().chain.units =
      4;  // 10 mm go nearly to the end: deep enough to distinguish the springs
  truth.pull = {.stiffness_N_per_m = 45.0, .limit_m = 8_mm};
  FitData data{.sites = {make_contact_point(truth, 100, 8_mm)}};
  answer(truth, "rhombus", data, true);
  Scene start = truth;
  start.pull.reset();
  auto& from = start.laws.of<model::indent::RhombusParameters>().chain;
  from.rod_length_m *= 1.2;
  from.initial_angle_rad = 0.6;
  from.normal_stiffness_N_per_m = 300.0;
  from.tangential_stiffness_N_per_m = 90.0;
  from.growth = 4.0;
  const FittedLaw fitted = fit("rhombus", start, data);
  EXPECT_TRUE(fitted.checked.follows);
  EXPECT_LT(fitted.checked.fitted.rms_ratio(), 1e-4);
  EXPECT_NEAR(value_of(fitted, "rod_length_m"), 5_mm, 0.02 * 5_mm);
  EXPECT_NEAR(value_of(fitted, "initial_angle_rad"), 0.5236, 0.02);
  EXPECT_NEAR(value_of(fitted, "normal_stiffness_N_per_m"), 150.0, 3.0);
  EXPECT_NEAR(value_of(fitted, "tangential_stiffness_N_per_m"), 180.0, 9.0);
  EXPECT_NEAR(value_of(fitted, "growth"), 2.0, 0.1);
  EXPECT_NEAR(fitted.keys[5].value, 45.0, 0.01);  // pull.stiffness_N_per_m
  // With noise of 1 % the curve stays, within less than the noise.
  spoil(data);
  FitLaw quick = law_named(start, data, "rhombus");
  quick.most_evaluations = 200;
  const auto noisy = fit_law(quick, start, data, {});
  ASSERT_TRUE(noisy);
  EXPECT_LT(noisy->checked.fitted.rms_ratio(), 0.012);
  EXPECT_NEAR(noisy->keys[5].value, 45.0, 1.0);
}

TEST(FitRun, FindsTheDiscStackThatMadeTheData) {
  const Scene truth = make_scene();
  FitData data{.sites = {make_contact_point(truth, 100, 0.0)}};
  answer(truth, "disc_stack", data, true);
  Scene start = make_scene();
  start.laws.of<model::indent::DiscStackParameters>().disc.youngs_modulus_Pa = 1e5;
  EXPECT_NEAR(value_of(fit("disc_stack_linear", start, data), "youngs_modulus_Pa"), 5200.0, 1.0);
  spoil(data);
  EXPECT_NEAR(value_of(fit("disc_stack_linear", start, data), "youngs_modulus_Pa"), 5200.0, 52.0);
}

TEST(FitRun, DoesNotDependOnTheOrderOfTheRows) {
  const Scene scene = make_scene();
  FitData data{.sites = {make_contact_point(scene, 100, 0.0)}};
  answer(scene, "disc_stack", data, false);
  for (FitSample& s : data.sites[0].samples) s.force_N *= 1.0 + 100.0 * s.depth_m;  // no law's
  const auto modulus_Pa = [&] {
    return value_of(fit("disc_stack_linear", scene, data), "youngs_modulus_Pa");
  };
  const double rising_Pa = modulus_Pa();
  std::reverse(data.sites[0].samples.begin(), data.sites[0].samples.end());
  EXPECT_NEAR(modulus_Pa(), rising_Pa, 1e-3 * rising_Pa);
}

TEST(FitRun, FindsTheConedDiscsThatMadeTheData) {
  Scene truth = make_scene();
  truth.laws.of<model::indent::DiscStackParameters>().form = model::indent::DiscForm::kAlmenLaszlo;
  FitData data{.sites = {make_contact_point(truth, 100, 0.0)}};
  answer(truth, "disc_stack", data, false);
  Scene start = make_scene();
  auto& from = start.laws.of<model::indent::DiscStackParameters>();
  from.disc.youngs_modulus_Pa = 2000.0;
  from.disc.free_height_m = 2.6_mm;
  const FittedLaw fitted = fit("disc_stack_almen_laszlo", start, data);
  EXPECT_NEAR(value_of(fitted, "youngs_modulus_Pa"), 5200.0, 10.0);
  EXPECT_NEAR(value_of(fitted, "free_height_m"), 2.7_mm, 0.01_mm);
  EXPECT_EQ(fitted.choice, "form = \"almen-laszlo\"");
  spoil(data);
  EXPECT_NEAR(value_of(fit("disc_stack_almen_laszlo", start, data), "youngs_modulus_Pa"), 5200.0,
              104.0);
}

TEST(FitRun, FindsThePowerLawThatMadeTheData) {
  const Scene truth = make_scene();
  FitData data{.sites = {make_contact_point(truth, 100, 0.0)}};
  answer(truth, "hunt_crossley", data, true);
  Scene start = make_scene();
  auto& from = start.laws.of<model::indent::HuntCrossleyParameters>();
  from.force_N = 3.0;
  from.exponent = 2.0;
  const FittedLaw fitted = fit("hunt_crossley", start, data);
  EXPECT_NEAR(value_of(fitted, "force_N"), 0.6, 0.006);
  EXPECT_NEAR(value_of(fitted, "exponent"), 1.4, 0.01);
  spoil(data);
  EXPECT_NEAR(value_of(fit("hunt_crossley", start, data), "exponent"), 1.4, 0.05);
}

TEST(FitRun, FindsTheHexagonalSheetThatMadeTheData) {
  const Scene truth = make_scene();
  FitData data{.sites = {make_contact_point(truth, 100, 0.0)}};
  answer(truth, "hex_sheet", data, true);
  Scene start = make_scene();
  auto& from = start.laws.of<model::indent::HexSheetParameters>();
  from.ring_pitch_m = 3_mm;
  from.contact_stiffness_N_per_m = 1.0;
  from.body_stiffness_N_per_m = 1.0;
  from.surface_stiffness_N_per_m = 10.0;
  from.tension_N = 0.1;
  const FittedLaw fitted = fit("hex_sheet", start, data);
  EXPECT_LT(fitted.checked.fitted.rms_ratio(), 1e-3);
  EXPECT_NEAR(value_of(fitted, "ring_pitch_m"), 2_mm, 0.1_mm);
  EXPECT_NEAR(value_of(fitted, "body_stiffness_N_per_m"), 4.0, 0.4);
  spoil(data);
  EXPECT_LT(fit("hex_sheet", start, data).checked.fitted.rms_ratio(), 0.012);
}

TEST(FitRun, FactorsOfTheSitesHaveTheMeanOne) {
  const Scene truth = make_scene();
  FitData data{.sites = {make_contact_point(truth, 100, 0.0), make_contact_point(truth, 60, 0.0)}};
  answer(truth, "disc_stack", data, false);
  for (FitSample& s : data.sites[1].samples) s.force_N *= 4.0;
  const FittedLaw fitted =
      fit("disc_stack_linear", truth, data, {.shape_weight = 0.0, .scale_by_site = true});
  EXPECT_TRUE(fitted.checked.follows);
  EXPECT_NEAR(fitted.checked.sites[0].scale, 0.5, 1e-3);
  EXPECT_NEAR(fitted.checked.sites[1].scale, 2.0, 4e-3);
  EXPECT_NEAR(value_of(fitted, "youngs_modulus_Pa"), 2.0 * 5200.0, 20.0);
}

TEST(FitRun, KeepsThePatchAsSoftAsTheDataAndItsMassInProportion) {
  Scene truth = make_scene();
  truth.organ_mesh = tests::make_plate(0.06, 8);
  truth.laws.of<model::springs::SpringPatchParameters>() = {
      .tissue = {.surface_stiffness_N_per_m = 40.0,
                 .body_stiffness_N_per_m = 10.0,
                 .damping_time_s = 0.004,
                 .body_damping_time_s = 0.004},
      .coupling_stiffness_N_per_m = 120.0,
      .node_mass_kg = 0.008,
      .working_depth_m = 12_mm,
      .nodes = 40};
  FitData data{.sites = {make_contact_point(truth, 40, 0.0)}};
  data.sites[0].samples = {{.depth_m = 10_mm}};
  answer(truth, "spring_patch", data, true);
  Scene start = truth;
  auto& from = start.laws.of<model::springs::SpringPatchParameters>().tissue;
  from.surface_stiffness_N_per_m = 80.0;
  from.body_stiffness_N_per_m = 10.0;
  FitLaw patient = law_named(start, data, "spring_patch");
  patient.most_evaluations = 150;
  const auto result = fit_law(patient, start, data, {});
  ASSERT_TRUE(result) << result.error().message;
  const FittedLaw& fitted = *result;
  EXPECT_LT(fitted.checked.fitted.rms_ratio(), 0.01);
  EXPECT_NEAR(
      value_of(fitted, "surface_stiffness_N_per_m") / value_of(fitted, "body_stiffness_N_per_m"),
      4.0, 0.4);
  const double springs = value_of(fitted, "surface_stiffness_N_per_m") +
                         value_of(fitted, "body_stiffness_N_per_m") +
                         value_of(fitted, "coupling_stiffness_N_per_m");
  EXPECT_NEAR(value_of(fitted, "node_mass_kg") / springs, 0.008 / 210.0, 1e-9);
}

}  // namespace tact::tools::fit::fit_run_test
