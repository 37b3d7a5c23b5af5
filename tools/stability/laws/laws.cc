// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/laws/laws.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <type_traits>

#include "model/indent/compliance_law.h"
#include "model/indent/disc_stack.h"
#include "model/indent/hex_sheet.h"
#include "model/indent/rhombus_chain.h"
#include "model/law/tabulated_law.h"
#include "tools/printed/hex_paper.h"

namespace tact::tools::stability {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

// LW-1: the table is then within 1e-6 of the largest force.
constexpr std::size_t kKnots = 65;

/// Laws that solve equations are rendered by a table, the others directly.
template <typename L>
void add(std::vector<NamedLaw>& laws, const char* name, const model::Result<L>& law,
         const char* beyond) {
  // Left out: a map shows what this build has.
  if (!law) return;
  const auto direct = std::make_shared<const L>(*law);
  // Laws in closed form are rendered directly.
  std::shared_ptr<const model::law::Law> rendered = direct;
  if constexpr (std::is_same_v<L, model::indent::RhombusChain> ||
                std::is_same_v<L, model::indent::HexSheet>) {
    if (auto table = model::law::tabulate(*direct, kKnots))
      rendered = std::make_shared<const model::law::TabulatedLaw>(*table);
  }
  laws.push_back(
      {name, direct, rendered, beyond, direct->range().press_m, rendered->range().press_m});
}

/// Laws with memory; the one that relaxes is the last closed-form law.
void add_memory(std::vector<NamedLaw>& laws) {
  if (!laws.empty()) {
    const NamedLaw& closed = laws.back();
    laws.push_back({.name = closed.name + " relaxing",
                    .law = nullptr,
                    .rendered = nullptr,
                    .beyond = "each part of the force stays at the working depth's and fades",
                    .range_m = closed.range_m,
                    .rendered_range_m = closed.rendered_range_m,
                    .make_contact_point = relaxing_maker(closed.rendered)});
  }
  for (const bool relaxes : {false, true})
    laws.push_back({.name = relaxes ? "spring patch relaxing" : "spring patch",
                    .law = nullptr,
                    .rendered = nullptr,
                    .beyond = "the nodes are pushed no further: the force stays",
                    .range_m = kPatchRange_m,
                    .rendered_range_m = kPatchRange_m,
                    .make_contact_point = patch_maker(relaxes)});
}

/// The chain of RC-13 at another angle, or with stiffer tangential springs.
model::indent::RhombusChainParameters chain(double angle_deg, double tangential_N_per_m) {
  return {.rod_length_m = 0.010,
          .initial_angle_rad = angle_deg * kDegree_rad,
          .normal_stiffness_N_per_m = 1500.0,
          .tangential_stiffness_N_per_m = tangential_N_per_m,
          .growth = 2.0,
          .units = 10};
}

/// The chain of the liver scene.
constexpr model::indent::RhombusChainParameters kLiver{.rod_length_m = 0.005,
                                                       .initial_angle_rad = 30.0 * kDegree_rad,
                                                       .normal_stiffness_N_per_m = 150.0,
                                                       .tangential_stiffness_N_per_m = 180.0,
                                                       .growth = 2.0,
                                                       .units = 10};

/// A tissue of 500 N/m in six layers of 3.6 mm (DS-13).
model::Result<model::indent::DiscStack> discs(model::indent::DiscForm form, double cone_ratio,
                                              double first_s) {
  return model::indent::make_disc_stack(
      model::indent::Disc{.outer_diameter_m = 8e-3,
                          .stiffness_N_per_m = 500.0,
                          .travel_m = 3.6e-3,
                          .cone_ratio = cone_ratio},
      form, {.first_delay_s = first_s, .delay_ratio = 1.1, .refresh_rate_Hz = 1000.0, .layers = 6});
}

// The defaults of HX-26.
constexpr model::indent::HexSheetParameters kSheet{.ring_pitch_m = 2e-3,
                                                   .contact_stiffness_N_per_m = 20.0,
                                                   .body_stiffness_N_per_m = 20.0,
                                                   .surface_stiffness_N_per_m = 200.0,
                                                   .tension_N = 0.1,
                                                   .rings = 15,
                                                   .weight = model::indent::HexWeight::kNode,
                                                   .working_depth_m = 8e-3};

/// Liver under a 4 mm tip, at a place that gives a little more than a half-space.
model::Result<model::indent::ComplianceCurve> compliance() {
  constexpr double kCompliance_m_per_N = 2e-3;
  constexpr std::size_t kRings = 12;
  std::array<double, kRings> ring{};
  for (std::size_t j = 0; j < kRings; ++j)
    ring[j] = kCompliance_m_per_N * (1.0 - static_cast<double>(j + 1) / kRings);
  return model::indent::make_compliance_curve(
      {.tip = {.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45, .radius_m = 4e-3},
       .regular_m_per_N = kCompliance_m_per_N,
       .working_depth_m = 0.01,
       .ring_pitch_m = 2.5e-3,
       .ring_m_per_N = ring,
       .table_knots = 65});
}

std::vector<NamedLaw> make_laws() {
  using model::indent::DiscForm;
  std::vector<NamedLaw> laws;
  add(laws, "rhombus (liver)", model::indent::make_rhombus_chain(kLiver),
      "rods flat: the force stays at its limit");
  add(laws, "rhombus (30 deg)", model::indent::make_rhombus_chain(chain(30.0, 1800.0)),
      "rods flat: the force stays at its limit");
  // RC-5: its slope is below zero before the rods are flat.
  add(laws, "rhombus (snaps)", model::indent::make_rhombus_chain(chain(45.0, 60000.0)),
      "a unit snaps: the stiffness is zero there and the force stays");
  add(laws, "discs linear", discs(DiscForm::kLinear, 0.4, 1e-5),
      "all layers flat: the force stays at its limit");
  add(laws, "discs eta 0.4", discs(DiscForm::kAlmenLaszlo, 0.4, 1e-5),
      "all layers flat: the force stays at its limit");
  // DS-5: flat, the slope is k (1 - eta^2/2).
  add(laws, "discs eta 1.4", discs(DiscForm::kAlmenLaszlo, 1.4, 1e-5),
      "next to sqrt 2 every layer ends without stiffness");
  // DS-8: T_i < 1 ms for four of the six layers.
  add(laws, "discs slow", discs(DiscForm::kAlmenLaszlo, 0.4, 2e-4),
      "the modelled delay ends the stack after a few layers");
  add(laws, "hex sheet", model::indent::make_hex_sheet(kSheet),
      "the force stays at the working depth's");
  model::indent::HexSheetParameters bare = kSheet;
  bare.tension_N = 0.0;
  add(laws, "hex sheet no tension", model::indent::make_hex_sheet(bare),
      "the indentation is a spike and the force stays");
  // X15: as printed, the force of both weights grows with the number of rings.
  const auto paper = [](model::indent::HexWeight weight) {
    return printed::make_hex_paper({.ring_pitch_m = 2e-3,
                                    .body_stiffness_N_per_m = 50.0,
                                    .rings = 25,
                                    .weight = weight,
                                    .working_depth_m = 8e-3});
  };
  add(laws, "hex printed ring", paper(model::indent::HexWeight::kRing),
      "the force stays; it would grow with the number of rings");
  add(laws, "hex printed node", paper(model::indent::HexWeight::kNode),
      "20 N/mm: the gate limits the force from 0.4 mm on");
  add(laws, "compliance", compliance(), "the force stays at the working depth's");
  add_memory(laws);
  return laws;
}

}  // namespace

const std::vector<NamedLaw>& probed_laws() {
  static const std::vector<NamedLaw> laws = make_laws();
  return laws;
}

double steepest_N_per_m(const NamedLaw& named) {
  constexpr int kSamples = 200;
  // From rest and down in steps, as a tool comes: one with memory answers to the way, too.
  RenderedTissue tissue = named.fresh();
  double most = 0.0;
  for (int i = 1; i <= kSamples; ++i)
    most = std::max(most, tissue.tick(named.rendered_range_m * i / kSamples).stiffness_N_per_m);
  return most;
}

}  // namespace tact::tools::stability
