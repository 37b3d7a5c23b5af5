#include "tools/fit/fit_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "model/compliance_file.h"
#include "model/units.h"
#include "tests/test_scene.h"

namespace tact::tools {
namespace {

using model::LawKind;
using model::Scene;
using model::operator""_mm;

/// A plate of 80 mm that all laws can be pressed into; numbers are the truth to be found.
Scene make_scene() {
  Scene scene = tests::make_plate_scene();
  scene.organ_mesh = tests::make_plate(0.08, 16);
  scene.described = {LawKind::kRhombus, LawKind::kDiscStack, LawKind::kHexSheet,
                     LawKind::kSpringPatch, LawKind::kCompliance};
  scene.table_knots = 33;
  scene.disc_stack = {
      .disc = {.outer_diameter_m = 8_mm,
               .inner_diameter_m = 4_mm,
               .thickness_m = 2_mm,
               .free_height_m = 2.7_mm,
               .youngs_modulus_Pa = 5200.0,
               .poisson_ratio = 0.3},
      .form = model::DiscForm::kLinear,
      .delays = {
          .first_delay_s = 1e-5, .delay_ratio = 1.1, .refresh_rate_Hz = 1000.0, .layers = 20}};
  scene.hex_sheet = {.ring_pitch_m = 2_mm,
                     .contact_stiffness_N_per_m = 8.0,
                     .body_stiffness_N_per_m = 4.0,
                     .surface_stiffness_N_per_m = 60.0,
                     .tension_N = 0.02,
                     .rings = 10,
                     .weight = model::HexWeight::kNode,
                     .working_depth_m = 12_mm};
  return scene;
}

FitLaw law_named(const Scene& scene, const FitData& data, const std::string& name) {
  for (FitLaw& law : fit_laws_of(scene, data))
    if (law.name == name) return law;
  ADD_FAILURE() << "no law " << name;
  return {};
}

/// Depths of one site, from pull to press, to be answered.
FitSite make_site(const Scene& scene, std::size_t vertex, double pull_m) {
  FitSite site{.name = std::to_string(vertex), .at = place_at_vertex(scene.organ_mesh, vertex)};
  for (const double share : {-1.0, -0.6, -0.2})
    if (pull_m > 0.0) site.samples.push_back({.depth_m = share * pull_m});
  for (int i = 1; i <= 12; ++i) site.samples.push_back({.depth_m = i * 10_mm / 12});
  return site;
}

void answer(const Scene& scene, LawKind kind, FitData& data, bool with_shapes) {
  data.ring_radius_m.clear();
  for (std::size_t k = 0; k < 8; ++k) data.ring_radius_m.push_back(4_mm * static_cast<double>(k));
  for (FitSite& site : data.sites)
    for (FitSample& s : site.samples)
      s.ring_m.assign(with_shapes ? data.ring_radius_m.size() : 0, 0.0);
  const auto answers = answers_of(scene, kind, data);
  ASSERT_TRUE(answers) << answers.error().sentence;
  std::size_t i = 0;
  for (FitSite& site : data.sites)
    for (FitSample& s : site.samples) {
      s.force_N = (*answers)[i].force_N;
      s.ring_m = (*answers)[i++].ring_m;
    }
}

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

double value_of(const FittedLaw& fitted, const std::string& key) {
  for (const FittedKey& k : fitted.keys)
    if (k.key == key) return k.value;
  ADD_FAILURE() << "no key " << key;
  return 0.0;
}

FittedLaw fit(const std::string& name, const Scene& start, const FitData& data,
              const FitOptions& options = {}) {
  const auto fitted = fit_law(law_named(start, data, name), start, data, options);
  EXPECT_TRUE(fitted) << fitted.error().sentence;
  return fitted ? *fitted : FittedLaw{};
}

TEST(FitRun, FindsTheRhombusChainThatMadeTheData) {
  Scene truth = make_scene();
  truth.rhombus.units = 4;  // 10 mm go nearly to the end: deep enough to tell the springs apart
  truth.pull = {.stiffness_N_per_m = 45.0, .limit_m = 8_mm};
  FitData data{.sites = {make_site(truth, 100, 8_mm)}};
  answer(truth, LawKind::kRhombus, data, true);
  Scene start = truth;
  start.pull.reset();
  start.rhombus.rod_length_m *= 1.2;
  start.rhombus.initial_angle_rad = 0.6;
  start.rhombus.normal_stiffness_N_per_m = 300.0;
  start.rhombus.tangential_stiffness_N_per_m = 90.0;
  start.rhombus.growth = 4.0;
  const FittedLaw fitted = fit("rhombus", start, data);
  EXPECT_TRUE(fitted.judged.follows);
  EXPECT_LT(fitted.judged.fitted.rms_ratio(), 1e-4);
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
  EXPECT_LT(noisy->judged.fitted.rms_ratio(), 0.012);
  EXPECT_NEAR(noisy->keys[5].value, 45.0, 1.0);
}

TEST(FitRun, FindsTheDiscStackThatMadeTheData) {
  const Scene truth = make_scene();
  FitData data{.sites = {make_site(truth, 100, 0.0)}};
  answer(truth, LawKind::kDiscStack, data, true);
  Scene start = make_scene();
  start.disc_stack.disc.youngs_modulus_Pa = 1e5;
  EXPECT_NEAR(value_of(fit("disc_stack_linear", start, data), "youngs_modulus_Pa"), 5200.0, 1.0);
  spoil(data);
  EXPECT_NEAR(value_of(fit("disc_stack_linear", start, data), "youngs_modulus_Pa"), 5200.0, 52.0);
}

TEST(FitRun, FindsTheConedDiscsThatMadeTheData) {
  Scene truth = make_scene();
  truth.disc_stack.form = model::DiscForm::kAlmenLaszlo;
  FitData data{.sites = {make_site(truth, 100, 0.0)}};
  answer(truth, LawKind::kDiscStack, data, false);
  Scene start = make_scene();
  start.disc_stack.disc.youngs_modulus_Pa = 2000.0;
  start.disc_stack.disc.free_height_m = 2.6_mm;
  const FittedLaw fitted = fit("disc_stack_almen_laszlo", start, data);
  EXPECT_NEAR(value_of(fitted, "youngs_modulus_Pa"), 5200.0, 10.0);
  EXPECT_NEAR(value_of(fitted, "free_height_m"), 2.7_mm, 0.01_mm);
  EXPECT_EQ(fitted.choice, "form = \"almen-laszlo\"");
  spoil(data);
  EXPECT_NEAR(value_of(fit("disc_stack_almen_laszlo", start, data), "youngs_modulus_Pa"), 5200.0,
              104.0);
}

TEST(FitRun, FindsTheHexagonalSheetThatMadeTheData) {
  const Scene truth = make_scene();
  FitData data{.sites = {make_site(truth, 100, 0.0)}};
  answer(truth, LawKind::kHexSheet, data, true);
  Scene start = make_scene();
  start.hex_sheet.ring_pitch_m = 3_mm;
  start.hex_sheet.contact_stiffness_N_per_m = 1.0;
  start.hex_sheet.body_stiffness_N_per_m = 1.0;
  start.hex_sheet.surface_stiffness_N_per_m = 10.0;
  start.hex_sheet.tension_N = 0.1;
  const FittedLaw fitted = fit("hex_sheet", start, data);
  EXPECT_LT(fitted.judged.fitted.rms_ratio(), 1e-3);
  EXPECT_NEAR(value_of(fitted, "ring_pitch_m"), 2_mm, 0.1_mm);
  EXPECT_NEAR(value_of(fitted, "body_stiffness_N_per_m"), 4.0, 0.4);
  spoil(data);
  EXPECT_LT(fit("hex_sheet", start, data).judged.fitted.rms_ratio(), 0.012);
}

TEST(FitRun, FactorsOfTheSitesHaveTheMeanOne) {
  const Scene truth = make_scene();
  FitData data{.sites = {make_site(truth, 100, 0.0), make_site(truth, 60, 0.0)}};
  answer(truth, LawKind::kDiscStack, data, false);
  for (FitSample& s : data.sites[1].samples) s.force_N *= 4.0;
  const FittedLaw fitted =
      fit("disc_stack_linear", truth, data, {.shape_weight = 0.0, .scale_by_site = true});
  EXPECT_TRUE(fitted.judged.follows);
  EXPECT_NEAR(fitted.judged.sites[0].scale, 0.5, 1e-3);
  EXPECT_NEAR(fitted.judged.sites[1].scale, 2.0, 4e-3);
  EXPECT_NEAR(value_of(fitted, "youngs_modulus_Pa"), 2.0 * 5200.0, 20.0);
}

TEST(FitRun, FindsTheModulusOfAnElasticOrgan) {
  Scene truth = make_scene();
  truth.elastic = {.youngs_modulus_Pa = 5000.0,
                   .poisson_ratio = 0.45,
                   .fixed_min_m = {-1, -1, -1},
                   .fixed_max_m = {1, -0.03, 1}};
  const std::size_t vertices = truth.organ_mesh.vertex_m.size();
  model::ComplianceMap map{.poisson_ratio = 0.45,
                           .patch_radius_m = 4_mm,
                           .ring_pitch_m = 4_mm,
                           .rings = 6,
                           .fixed_min_m = truth.elastic->fixed_min_m,
                           .fixed_max_m = truth.elastic->fixed_max_m,
                           .mesh_hash = surface_hash(truth.organ_mesh.view())};
  for (std::size_t v = 0; v < vertices; ++v) {
    const float give = static_cast<float>(v) / static_cast<float>(vertices) * 30.0F;
    map.regular_times_E_per_m.push_back(give);
    map.sideways_times_E_per_m.push_back({0.0F, 0.0F, give, give});
    for (int k = 6; k > 0; --k) map.ring_times_E_per_m.push_back(give * static_cast<float>(k) / 7);
  }
  truth.compliance = {
      .map_path =
          (std::filesystem::temp_directory_path() / "tact_fit_run_test.compliance").string(),
      .working_depth_m = 12_mm,
      .curves = 9};
  ASSERT_TRUE(write_compliance_map(map, truth.compliance.map_path));
  FitData data{.sites = {make_site(truth, 60, 8_mm), make_site(truth, 200, 8_mm)}};
  data.sites[1].held_out = true;
  answer(truth, LawKind::kCompliance, data, true);
  Scene start = truth;
  start.elastic->youngs_modulus_Pa = 900.0;
  const FittedLaw fitted = fit("compliance", start, data);
  EXPECT_NEAR(value_of(fitted, "youngs_modulus_Pa"), 5000.0, 1.0);
  EXPECT_LT(fitted.judged.held_out.rms_ratio(), 1e-3);  // the map knows the other site
  // One stiffness for both places cannot be right, and says so.
  const FittedLaw chain = fit("disc_stack_linear", start, data);
  EXPECT_FALSE(chain.judged.follows);
  EXPECT_GT(chain.judged.held_out.rms_ratio(), 2.0 * fitted.judged.held_out.rms_ratio());
  data.sites[0].at.reset();
  const auto without_place =
      fit_law(law_named(start, data, "compliance"), start, data, FitOptions{});
  ASSERT_FALSE(without_place);
  EXPECT_NE(without_place.error().sentence.find("column site"), std::string::npos);
  std::filesystem::remove(truth.compliance.map_path);
}

TEST(FitRun, KeepsThePatchAsSoftAsTheDataAndItsMassInProportion) {
  Scene truth = make_scene();
  truth.organ_mesh = tests::make_plate(0.06, 8);
  truth.spring_patch = {.tissue = {.surface_stiffness_N_per_m = 40.0,
                                   .body_stiffness_N_per_m = 10.0,
                                   .damping_time_s = 0.004,
                                   .body_damping_time_s = 0.004},
                        .coupling_stiffness_N_per_m = 120.0,
                        .node_mass_kg = 0.008,
                        .working_depth_m = 12_mm,
                        .nodes = 40};
  FitData data{.sites = {make_site(truth, 40, 0.0)}};
  data.sites[0].samples = {{.depth_m = 10_mm}};
  answer(truth, LawKind::kSpringPatch, data, true);
  Scene start = truth;
  start.spring_patch.tissue.surface_stiffness_N_per_m = 80.0;
  start.spring_patch.tissue.body_stiffness_N_per_m = 10.0;
  FitLaw patient = law_named(start, data, "spring_patch");
  patient.most_evaluations = 150;
  const auto result = fit_law(patient, start, data, {});
  ASSERT_TRUE(result) << result.error().sentence;
  const FittedLaw& fitted = *result;
  EXPECT_LT(fitted.judged.fitted.rms_ratio(), 0.01);
  EXPECT_NEAR(
      value_of(fitted, "surface_stiffness_N_per_m") / value_of(fitted, "body_stiffness_N_per_m"),
      4.0, 0.4);
  const double springs = value_of(fitted, "surface_stiffness_N_per_m") +
                         value_of(fitted, "body_stiffness_N_per_m") +
                         value_of(fitted, "coupling_stiffness_N_per_m");
  EXPECT_NEAR(value_of(fitted, "node_mass_kg") / springs, 0.008 / 210.0, 1e-9);
}

}  // namespace
}  // namespace tact::tools
