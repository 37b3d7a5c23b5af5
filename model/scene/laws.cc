// SPDX-License-Identifier: Apache-2.0
#include "model/scene/laws.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/indent/disc_series.h"
#include "model/indent/disc_stack.h"
#include "model/indent/hex_sheet.h"
#include "model/indent/hunt_crossley.h"
#include "model/indent/membrane.h"
#include "model/indent/rhombus_patch.h"
#include "model/indent/table_law.h"
#include "model/scene/scene.h"
#include "model/scene/table_file.h"
#include "model/scene/tissue_law_builder.h"
#include "model/scene/tissue_map.h"
#include "model/springs/spring_patch.h"

namespace tact::model::scene {
namespace {

template <typename Parameters>
void keys_of(ParameterVisitor& v, Scene& scene) {
  visit(v, scene.laws.of<Parameters>());
}

template <typename L>
std::unique_ptr<law::Law> owned(L law) {
  return std::make_unique<L>(std::move(law));
}

Result<Curve> hunt_crossley(const Scene& scene) {
  const auto& p = scene.laws.of<indent::HuntCrossleyParameters>();
  auto law = make_hunt_crossley(p);
  if (!law) return law.error();
  return Curve{.law = owned(std::move(*law)),
               .title = fmt::format("force ~ depth^{:g} (1 + {:g} s/m speed)", p.exponent,
                                    p.dissipation_s_per_m)};
}

Result<Curve> rhombus(const Scene& scene) {
  const auto& p = scene.laws.of<indent::RhombusParameters>();
  const std::string title = fmt::format("rhombus chain, energy form, {} units", p.chain.units);
  auto chain = make_rhombus_chain(p.chain);
  if (!chain) return chain.error();
  if (p.area_m2 == 0.0) return Curve{.law = owned(std::move(*chain)), .title = title};
  const auto tip_radius_m = scene_tip_radius_m(scene);
  if (!tip_radius_m) return tip_radius_m.error();
  auto patch = make_rhombus_patch(*chain, {.tip_radius_m = *tip_radius_m, .area_m2 = p.area_m2});
  if (!patch) return patch.error();
  return Curve{.law = owned(std::move(*patch)), .title = title + ", in parallel under the tip"};
}

// Closed form already: a table would smooth the steps that the discs have.
Result<Curve> disc_stack(const Scene& scene) {
  const auto& p = scene.laws.of<indent::DiscStackParameters>();
  auto stack = make_disc_stack(p);
  if (!stack) return stack.error();
  const std::string title = fmt::format(
      "disc stack, {}, {} layers", p.form == indent::DiscForm::kLinear ? "linear" : "Almen-Laszlo",
      stack->layer_count());
  return Curve{
      .law = owned(std::move(*stack)), .title = title, .untabled_bytes = sizeof(indent::DiscStack)};
}

// Closed form, too.
Result<Curve> disc_series(const Scene& scene) {
  auto series = make_disc_series(scene.laws.of<indent::DiscSeriesParameters>());
  if (!series) return series.error();
  const std::string title = fmt::format("{} discs in series", series->size());
  return Curve{.law = owned(std::move(*series)),
               .title = title,
               .untabled_bytes = sizeof(indent::DiscSeries)};
}

Result<Curve> hex_sheet(const Scene& scene) {
  auto parameters = scene.laws.of<indent::HexSheetParameters>();
  if (parameters.rings == 0) {
    constexpr double kRingTolerance_ratio = 0.01;  // of the force, where the scene states none
    auto rings = rings_for_tolerance(
        parameters, scene.tolerance ? scene.tolerance->force_error_ratio : kRingTolerance_ratio);
    if (!rings) return rings.error();
    parameters.rings = *rings;
  }
  auto sheet = make_hex_sheet(parameters);
  if (!sheet) return sheet.error();
  // LW-2: its rings are given by the source, so it is drawn by them.
  return Curve{.law = owned(std::move(*sheet)),
               .title = fmt::format("hexagonal sheet, energy form, {} rings", parameters.rings),
               .draws_tissue = true};
}

Result<Curve> membrane(const Scene& scene) {
  const auto tip_radius_m = scene_tip_radius_m(scene);
  if (!tip_radius_m) return tip_radius_m.error();
  auto law = make_membrane(scene.laws.of<indent::MembraneParameters>(), *tip_radius_m);
  if (!law) return law.error();
  return Curve{.law = owned(std::move(*law)), .title = "membrane on a softening foundation"};
}

Result<Curve> table(const Scene& scene) {
  const auto& p = scene.laws.of<indent::TableParameters>();
  if (p.data.empty()) return Error{"table.data names no file; write data = \"press.csv\""};
  const auto rows = read_table_file(p.data);
  if (!rows) return rows.error();
  auto law = make_table_law(*rows, p);
  if (!law) return Error{p.data + law.error().message};
  std::string title = fmt::format("measured table, {} rows", rows->size());
  if (law->lost_ratio() > 0.0)
    title += fmt::format(", without the {:.0f} % of the work that its unloading loses",
                         100.0 * law->lost_ratio());
  // A table of its own, denser at light touch than the loop's.
  return Curve{.law = owned(std::move(*law)),
               .title = std::move(title),
               .is_measured = true,
               .untabled_bytes = sizeof(indent::TableLaw)};
}

void compliance_keys(ParameterVisitor& v, Scene& scene) {
  ComplianceSettings& c = scene.compliance;
  v.file("map", "file of tact-lab condense, absolute or from the scene's folder", c.map_path,
         Need::kOptional);
  v.number("layer_thickness_m", kDepth_m, "in place of a map: a wide flat layer on its support",
           c.layer_thickness_m, Need::kOptional);
  if (c.map_path.empty() == !(c.layer_thickness_m > 0.0))
    v.refuse({"map", "layer_thickness_m"},
             "write compliance.map, or compliance.layer_thickness_m for a wide layer; one of both");
  v.number("working_depth_m", kDepth_m, "press and pull up to here", c.working_depth_m);
  v.count("curves", {2, 65}, "of the family, soft to stiff", c.curves, Need::kOptional);
  v.flag("large_strain", "organ and tip; false: small strain, as a linear reference",
         c.large_strain, Need::kOptional);
}

}  // namespace

// Sizes: each about twice the one before, so that the chart shows where more buys nothing.
// NOLINTNEXTLINE(readability-function-size): a table of laws
std::span<const LawRow> all_laws() {
  static const std::vector<LawRow> rows{
      {.name = "rhombus",
       .meaning = "energy-consistent chain of rhombus units",
       .visit = keys_of<indent::RhombusParameters>,
       .curve = rhombus,
       .stiffness_keys = {"normal_stiffness_N_per_m", "tangential_stiffness_N_per_m"},
       .fit_keys = {"rod_length_m", "initial_angle_rad", "normal_stiffness_N_per_m",
                    "tangential_stiffness_N_per_m", "growth"},
       // As the scene, steeper, and with the tangential springs strong or nearly away.
       .fit_starts = {{1, 1, 1, 1, 1}, {1, 1.8, 1, 1, 1}, {0.5, 2.4, 1, 5, 3}, {2, 1, 1, 0.1, 1}},
       .sizes = {17, 33, 65, 129},
       .quick_sizes = {17, 65}},
      {.name = "disc_stack",
       .meaning = "coned discs that go flat one after the other",
       .visit = keys_of<indent::DiscStackParameters>,
       .curve = disc_stack,
       .stiffness_keys = {"youngs_modulus_Pa"},
       .fit_keys = {"youngs_modulus_Pa"},
       .size_key = "layers"},
      {.name = "disc_series",
       .meaning = "disc springs in series that go flat in turn, as a ball stiffens",
       .visit = keys_of<indent::DiscSeriesParameters>,
       .curve = disc_series,
       .stiffness_keys = {"force_N"},
       .fit_keys = {"force_N", "exponent"},
       .fit_starts = {{1, 1}, {1, 1.3}},
       .size_key = "discs",
       .sizes = {4, 6, 9, 12, 18},
       .quick_sizes = {6, 9}},
      {.name = "hex_sheet",
       .meaning = "hexagonal skin on body springs, energy form",
       .visit = keys_of<indent::HexSheetParameters>,
       .curve = hex_sheet,
       .stiffness_keys = {"body_stiffness_N_per_m", "contact_stiffness_N_per_m",
                          "surface_stiffness_N_per_m", "tension_N"},
       .fit_keys = {"ring_pitch_m", "body_stiffness_N_per_m", "contact_stiffness_N_per_m",
                    "surface_stiffness_N_per_m", "tension_N"},
       .fit_starts = {{1, 1, 1, 1, 1}, {2, 1, 1, 1, 3}, {1, 0.1, 1, 3, 1}, {0.5, 1, 10, 10, 0.3}},
       .size_key = "rings",
       .sizes = {3, 5, 10, 15, 25},
       .quick_sizes = {5, 15}},
      {.name = "membrane",
       .meaning = "tensioned skin on a softening foundation, under a round tip",
       .visit = keys_of<indent::MembraneParameters>,
       .curve = membrane,
       .stiffness_keys = {"tension_N_per_m", "foundation_Pa_per_m"},
       .fit_keys = {"tension_N_per_m", "foundation_Pa_per_m", "softening_depth_m",
                    "softening_exponent"},
       .sizes = {17, 33, 65, 129},
       .quick_sizes = {17, 65}},
      {.name = "hunt_crossley",
       .meaning = "power law that resists speed as well",
       .visit = keys_of<indent::HuntCrossleyParameters>,
       .curve = hunt_crossley,
       .stiffness_keys = {"force_N"},
       .damping_key = "dissipation_s_per_m",
       // The dissipation stays: data of a slow press does not determine it.
       .fit_keys = {"force_N", "exponent"},
       .fit_starts = {{1, 1}, {1, 1.3}}},
      {.name = "spring_patch",
       .meaning = "masses and springs on the organ's mesh near the contact",
       .visit = keys_of<springs::SpringPatchParameters>,
       .build = &TissueLawBuilder::add_spring_patch,
       .stiffness_keys = {"coupling_stiffness_N_per_m"},
       .fit_keys = {"surface_stiffness_N_per_m", "body_stiffness_N_per_m",
                    "coupling_stiffness_N_per_m"},
       .size_key = "nodes",
       .can_be_cut = true,
       .sizes = {50, 100, 200, 500, 1000},
       .quick_sizes = {100}},
      {.name = "table",
       .meaning = "the force of a press that was measured",
       .visit = keys_of<indent::TableParameters>,
       .curve = table,
       .stiffness_keys = {"force_ratio"}},
      {.name = "compliance",
       .meaning = "the elastic organ of [elastic], condensed to its surface offline",
       .visit = compliance_keys,
       .build = &TissueLawBuilder::add_compliance,
       .size_key = "curves",
       .follows_elastic = true,
       .sizes = {2, 3, 5, 9, 17, 33},
       .quick_sizes = {5, 17}},
  };
  return rows;
}

const LawRow* find_law(std::string_view name) {
  const auto found = std::ranges::find(all_laws(), name, &LawRow::name);
  return found == all_laws().end() ? nullptr : &*found;
}

bool follows_elastic(const Scene& scene) {
  const LawRow* law = find_law(scene.law);
  return scene.varies_by_place || scene.exact_tip || (law != nullptr && law->follows_elastic);
}

ParameterList parameters_of(const LawRow& law, Scene& scene) {
  ParameterList list;
  law.visit(list, scene);
  return list;
}

}  // namespace tact::model::scene
