// SPDX-License-Identifier: Apache-2.0
// fit_fixture.h - scenes whose laws are the truth, data that they answer, and what a fit makes of
// it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "model/indent/disc_stack.h"
#include "model/indent/hex_sheet.h"
#include "model/indent/hunt_crossley.h"
#include "model/units.h"
#include "tests/support/test_scene.h"
#include "tools/fit/fit_run.h"

namespace tact::tools::fit {

using model::scene::Scene;
using model::operator""_mm;

/// A plate of 80 mm that all laws can be pressed into; numbers are the truth to be found.
inline Scene make_scene() {
  Scene scene = tests::make_plate_scene();
  scene.organ_mesh = tests::make_plate(0.08, 16);
  scene.described = {"rhombus",      "disc_stack", "hex_sheet",
                     "spring_patch", "compliance", "hunt_crossley"};
  scene.table_knots = 33;
  scene.laws.of<model::indent::DiscStackParameters>() = {
      .disc = {.outer_diameter_m = 8_mm,
               .inner_diameter_m = 4_mm,
               .thickness_m = 2_mm,
               .free_height_m = 2.7_mm,
               .youngs_modulus_Pa = 5200.0,
               .poisson_ratio = 0.3},
      .form = model::indent::DiscForm::kLinear,
      .delays = {
          .first_delay_s = 1e-5, .delay_ratio = 1.1, .refresh_rate_Hz = 1000.0, .layers = 20}};
  scene.laws.of<model::indent::HexSheetParameters>() = {.ring_pitch_m = 2_mm,
                                                        .contact_stiffness_N_per_m = 8.0,
                                                        .body_stiffness_N_per_m = 4.0,
                                                        .surface_stiffness_N_per_m = 60.0,
                                                        .tension_N = 0.02,
                                                        .rings = 10,
                                                        .weight = model::indent::HexWeight::kNode,
                                                        .working_depth_m = 12_mm};
  scene.laws.of<model::indent::HuntCrossleyParameters>() = {
      .force_N = 0.6, .working_depth_m = 12_mm, .exponent = 1.4};
  return scene;
}

inline FitLaw law_named(const Scene& scene, const FitData& data, const std::string& name) {
  for (FitLaw& law : fit_laws_of(scene, data))
    if (law.name == name) return law;
  ADD_FAILURE() << "no law " << name;
  return {};
}

/// Depths of one site, from pull to press, to be answered.
inline FitSite make_contact_point(const Scene& scene, std::size_t vertex, double pull_m) {
  FitSite site{.name = std::to_string(vertex),
               .at = surface_point_at_vertex(scene.organ_mesh, vertex)};
  for (const double share : {-1.0, -0.6, -0.2})
    if (pull_m > 0.0) site.samples.push_back({.depth_m = share * pull_m});
  for (int i = 1; i <= 12; ++i) site.samples.push_back({.depth_m = i * 10_mm / 12});
  return site;
}

inline void answer(const Scene& scene, const std::string& kind, FitData& data, bool with_shapes) {
  data.ring_radius_m.clear();
  for (std::size_t k = 0; k < 8; ++k) data.ring_radius_m.push_back(4_mm * static_cast<double>(k));
  for (FitSite& site : data.sites)
    for (FitSample& s : site.samples)
      s.ring_m.assign(with_shapes ? data.ring_radius_m.size() : 0, 0.0);
  const auto answers = answers_of(scene, kind, data);
  ASSERT_TRUE(answers) << answers.error().message;
  std::size_t i = 0;
  for (FitSite& site : data.sites)
    for (FitSample& s : site.samples) {
      s.force_N = (*answers)[i].force_N;
      s.ring_m = (*answers)[i++].ring_m;
    }
}

inline double value_of(const FittedLaw& fitted, const std::string& key) {
  for (const FittedKey& k : fitted.keys)
    if (k.key == key) return k.value;
  ADD_FAILURE() << "no key " << key;
  return 0.0;
}

inline FittedLaw fit(const std::string& name, const Scene& start, const FitData& data,
                     const FitOptions& options = {}) {
  const auto fitted = fit_law(law_named(start, data, name), start, data, options);
  EXPECT_TRUE(fitted) << fitted.error().message;
  return fitted ? *fitted : FittedLaw{};
}

}  // namespace tact::tools::fit
