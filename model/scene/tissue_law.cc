// SPDX-License-Identifier: Apache-2.0
#include "model/scene/tissue_law.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/indent/rhombus_patch.h"
#include "model/law/tabulated_law.h"
#include "model/scene/tissue_law_builder.h"
#include "model/scene/tissue_map.h"
#include "model/tissue/compliance_family.h"

namespace tact::model::scene {
namespace {

constexpr double kRingTolerance = 0.01;  // of the force, where the scene states none

}  // namespace

std::optional<Error> TissueLawBuilder::build(LawKind kind) {
  switch (kind) {
    case LawKind::kRhombus:
      return add_rhombus();
    case LawKind::kDiscStack:
      return add_disc_stack();
    case LawKind::kHexSheet:
      return add_hex_sheet();
    case LawKind::kHuntCrossley:
      return add_hunt_crossley();
    case LawKind::kCompliance:
      return add_compliance();
    case LawKind::kSpringPatch:
      return add_spring_patch();
    default:
      return Error{
          fmt::format("{}: law \"{}\" cannot be felt; choose another", scene_.path, name_of(kind))};
  }
}

TissueLawBuilder::Step TissueLawBuilder::add_rhombus() {
  law_->title_ = fmt::format("rhombus chain, energy form, {} units", scene_.rhombus.units);
  auto chain = make_rhombus_chain(scene_.rhombus);
  if (!chain) return blame(chain.error());
  if (scene_.rhombus_area_m2 == 0.0) return add_table(keep(std::move(*chain)));
  const auto tip_radius_m = scene_tip_radius_m(scene_);
  if (!tip_radius_m) return tip_radius_m.error();
  auto patch = make_rhombus_patch(
      *chain, {.tip_radius_m = *tip_radius_m, .area_m2 = scene_.rhombus_area_m2});
  if (!patch) return blame(patch.error());
  law_->title_ += ", in parallel under the tip";
  return add_table(keep(std::move(*patch)));
}

// Closed form already: a table would smooth the steps that the discs have.
TissueLawBuilder::Step TissueLawBuilder::add_disc_stack() {
  auto stack = make_disc_stack(scene_.disc_stack);
  if (!stack) return blame(stack.error());
  law_->title_ =
      fmt::format("disc stack, {}, {} layers",
                  scene_.disc_stack.form == indent::DiscForm::kLinear ? "linear" : "Almen-Laszlo",
                  stack->layer_count());
  auto pulled = with_pull(keep(std::move(*stack)));
  if (!pulled) return pulled.error();
  law_->memory_bytes_ += sizeof(indent::DiscStack);
  return finish_curve(**pulled);
}

TissueLawBuilder::Step TissueLawBuilder::add_hex_sheet() {
  auto parameters = scene_.hex_sheet;
  // 0: chosen here, as few as the tolerance allows.
  if (parameters.rings == 0) {
    const double tolerance_ratio =
        scene_.tolerance ? scene_.tolerance->force_error_ratio : kRingTolerance;
    auto rings = rings_for_tolerance(parameters, tolerance_ratio);
    if (!rings) return blame(rings.error());
    parameters.rings = *rings;
  }
  law_->title_ = fmt::format("hexagonal sheet, energy form, {} rings", parameters.rings);
  auto sheet = make_hex_sheet(parameters);
  if (!sheet) return blame(sheet.error());
  // LW-2: its rings are given by the source, so it is drawn by them.
  draws_tissue_ = true;
  return add_table(keep(std::move(*sheet)));
}

TissueLawBuilder::Step TissueLawBuilder::add_hunt_crossley() {
  law_->title_ =
      fmt::format("Hunt and Crossley, force ~ depth^{:g} (1 + {:g} s/m speed)",
                  scene_.hunt_crossley.exponent, scene_.hunt_crossley.dissipation_s_per_m);
  auto law = make_hunt_crossley(scene_.hunt_crossley);
  if (!law) return blame(law.error());
  return add_table(keep(std::move(*law)));
}

TissueLawBuilder::Step TissueLawBuilder::add_compliance() {
  const bool large_strain = scene_.compliance.large_strain;
  law_->title_ = fmt::format("elastic compliance, {} strain under the tip, {} curves",
                             large_strain ? "large" : "small", scene_.compliance.curves);
  auto family = read_scene_family(scene_, large_strain);
  if (!family) return family.error();
  for (indent::ComplianceCurve& curve : family->curve)
    law_->curves_.push_back(&keep(std::move(curve)));
  law_->press_coordinate_ = std::move(family->press_coordinate);
  law_->pull_coordinate_ = std::move(family->pull_coordinate);
  law_->curve_rings_times_E_per_m_ = std::move(family->ring_times_E_per_m);
  law_->memory_bytes_ += law_->curves_.size() * sizeof(indent::ComplianceCurve);
  return finish_field();
}

// The hand meets no more than the virtual spring, whatever the nodes do in one tick.
TissueLawBuilder::Step TissueLawBuilder::add_spring_patch() {
  // As the patch does: a mesh may have fewer vertices.
  const std::size_t nodes = std::min(scene_.spring_patch.nodes, scene_.organ_mesh.vertex_m.size());
  law_->title_ = fmt::format("mass-spring patch, {} nodes, {}", nodes,
                             name_of(scene_.spring_patch.method.integrator));
  springs::SpringPatchParameters parameters = scene_.spring_patch;
  // What the scene says elsewhere: rate, tool, relaxation.
  parameters.tick_s = 1.0 / scene_.rate_Hz;
  parameters.spheres = scene_.tool.spheres.size();
  auto relaxation = make_relaxation(scene_.relaxation, parameters.tick_s);
  if (!relaxation) return blame(relaxation.error());
  parameters.relaxation = *relaxation;
  const auto compliance_m_per_N = read_scene_compliance(scene_);
  if (!compliance_m_per_N) return compliance_m_per_N.error();
  parameters.tissue.compliance_m_per_N = *compliance_m_per_N;
  auto patch = make_spring_patch(scene_.organ_mesh.view(), parameters);
  if (!patch) return blame(patch.error());
  law_->range_ = {-parameters.working_depth_m, parameters.working_depth_m};
  law_->press_stiffness_N_per_m_ = parameters.coupling_stiffness_N_per_m;
  law_->memory_bytes_ = (*patch)->memory_bytes();
  law_->contact_law_ = std::move(*patch);
  return std::nullopt;
}

/// Press as the law gives it, pull as [pull] says.
Result<const law::Law*> TissueLawBuilder::with_pull(const law::Law& press) {
  // Without [pull] the law's own pull counts, if it has one.
  if (!scene_.pull) return &press;
  auto pulled = make_linear_pull(press, *scene_.pull);
  if (!pulled) return blame(pulled.error());
  return &keep(std::move(*pulled));
}

TissueLawBuilder::Step TissueLawBuilder::add_table(const law::Law& direct) {
  auto law = with_pull(direct);
  if (!law) return law.error();
  auto table = tabulate(**law, scene_.table_knots);
  if (!table) return blame(table.error());
  law_->memory_bytes_ += sizeof(law::TabulatedLaw);
  return finish_curve(keep(std::move(*table)));
}

Result<std::unique_ptr<TissueLaw>> make_tissue_law(const Scene& scene, LawKind kind) {
  TissueLawBuilder builder(scene);
  if (auto failed = builder.build(kind)) return *failed;
  return builder.take();
}

}  // namespace tact::model::scene
