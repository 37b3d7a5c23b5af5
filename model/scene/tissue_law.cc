// SPDX-License-Identifier: Apache-2.0
#include "model/scene/tissue_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/law/law_bounds.h"
#include "model/law/rhombus_patch.h"
#include "model/law/series_law.h"
#include "model/law/tabulated_law.h"
#include "model/scene/tissue_map.h"
#include "model/tissue/compliance_family.h"
#include "model/tissue/elastic_field.h"

namespace tact::model::scene {
namespace {

constexpr double kRingTolerance = 0.01;  // of the force, where the scene states none
// A place over the law alone: what devices can render, and more than any 2 mm from the held side.
constexpr double kStiffestPlace_ratio = 1.5;

/// NaN is the stiffest of all, so that what must bound it refuses it.
double stiffer_N_per_m(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

}  // namespace

// Curves first (add_*), then finish(), which measures what was built.
class TissueLawBuilder {
 public:
  explicit TissueLawBuilder(const Scene& scene) : scene_(scene) {}

  std::optional<Error> build(LawKind kind);
  std::unique_ptr<TissueLaw> take() { return std::move(law_); }

 private:
  using Step = std::optional<Error>;

  Step add_rhombus();
  Step add_disc_stack();
  Step add_hex_sheet();
  Step add_hunt_crossley();
  Step add_compliance();
  Step add_spring_patch();
  Step add_table(const law::Law& direct);
  Result<const law::Law*> with_pull(const law::Law& press);
  Step finish_curve(const law::Law& curve);
  Step vary_by_place(const law::Law& curve);
  Step finish_field(const law::Law* shape = nullptr);
  tissue::ElasticNeighbours neighbours();
  void measure(const law::Law& curve);

  /// Keeps a law and returns where it lives.
  template <typename L>
  L& keep(L&& law) {
    auto owned = std::make_unique<std::decay_t<L>>(std::forward<L>(law));
    auto& place = *owned;
    law_->owned_.push_back(std::move(owned));
    return place;
  }
  Error blame(const Error& error) const { return {scene_.path + ": " + error.sentence}; }

  const Scene& scene_;
  bool draws_tissue_ = false;  // the law itself, not as springs in a row
  std::unique_ptr<TissueLaw> law_ = std::make_unique<TissueLaw>();
};

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
                  scene_.disc_stack.form == law::DiscForm::kLinear ? "linear" : "Almen-Laszlo",
                  stack->layer_count());
  auto pulled = with_pull(keep(std::move(*stack)));
  if (!pulled) return pulled.error();
  law_->memory_bytes_ += sizeof(law::DiscStack);
  return finish_curve(**pulled);
}

TissueLawBuilder::Step TissueLawBuilder::add_hex_sheet() {
  auto parameters = scene_.hex_sheet;
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
  for (law::ComplianceCurve& curve : family->curve)
    law_->curves_.push_back(&keep(std::move(curve)));
  law_->press_coordinate_ = std::move(family->press_coordinate);
  law_->pull_coordinate_ = std::move(family->pull_coordinate);
  law_->memory_bytes_ += law_->curves_.size() * sizeof(law::ComplianceCurve);
  return finish_field();
}

/// One law everywhere, or in series with the give of each place.
TissueLawBuilder::Step TissueLawBuilder::finish_curve(const law::Law& curve) {
  if (scene_.varies_by_place) return vary_by_place(curve);
  law_->curves_.push_back(&curve);
  if (draws_tissue_) return finish_field();
  auto shape = law::half_space_under(scene_.tool.spheres[0].radius_m, curve.range().press_m);
  if (!shape) return blame(shape.error());
  return finish_field(&keep(std::move(*shape)));
}

// The law is the tip's own dent, the same everywhere; each curve of the family adds its give, which
// is one of small strain.
TissueLawBuilder::Step TissueLawBuilder::vary_by_place(const law::Law& curve) {
  auto family = read_scene_family(scene_, false);
  if (!family) return family.error();
  const law::LawRange range = curve.range();
  const double least_m_per_N = (1.0 / kStiffestPlace_ratio - 1.0) /
                               law::stiffest_N_per_m(curve, range.pull_m, range.press_m);
  for (law::ComplianceCurve& of_family : family->curve) {
    const law::ComplianceCurve& place = keep(std::move(of_family));
    const double give_m_per_N = std::max(place.regular_m_per_N(), least_m_per_N);
    auto series = make_series_law(curve, give_m_per_N, place);
    if (!series) return blame(series.error());
    auto table = tabulate(keep(std::move(*series)), scene_.table_knots);
    if (!table) return blame(table.error());
    law_->curves_.push_back(&keep(std::move(*table)));
  }
  law_->title_ += ", in series with the organ";
  law_->press_coordinate_ = std::move(family->press_coordinate);
  law_->pull_coordinate_ = std::move(family->pull_coordinate);
  law_->memory_bytes_ += law_->curves_.size() * sizeof(law::TabulatedLaw);
  return finish_field();
}

// The hand meets no more than the virtual spring, whatever the nodes do in one tick.
TissueLawBuilder::Step TissueLawBuilder::add_spring_patch() {
  const std::size_t nodes = std::min(scene_.spring_patch.nodes, scene_.organ_mesh.vertex_m.size());
  law_->title_ = fmt::format("mass-spring patch, {} nodes, {}", nodes,
                             name_of(scene_.spring_patch.method.integrator));
  springs::SpringPatchParameters parameters = scene_.spring_patch;
  parameters.tick_s = 1.0 / scene_.rate_Hz;
  parameters.spheres = scene_.tool.spheres.size();
  auto relaxation = make_relaxation(scene_.relaxation, parameters.tick_s);
  if (!relaxation) return blame(relaxation.error());
  parameters.relaxation = *relaxation;
  const auto give_m_per_N = read_scene_give(scene_);
  if (!give_m_per_N) return give_m_per_N.error();
  parameters.tissue.give_m_per_N = *give_m_per_N;
  auto patch = make_spring_patch(scene_.organ_mesh.view(), parameters);
  if (!patch) return blame(patch.error());
  law_->range_ = {-parameters.working_depth_m, parameters.working_depth_m};
  law_->press_stiffness_N_per_m_ = parameters.coupling_stiffness_N_per_m;
  law_->memory_bytes_ = (*patch)->memory_bytes();
  law_->site_law_ = std::move(*patch);
  return std::nullopt;
}

/// Press as the law gives it, pull as [pull] says.
Result<const law::Law*> TissueLawBuilder::with_pull(const law::Law& press) {
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

TissueLawBuilder::Step TissueLawBuilder::finish_field(const law::Law* shape) {
  auto relaxation = make_relaxation(scene_.relaxation, 1.0 / scene_.rate_Hz);
  if (!relaxation) return blame(relaxation.error());
  law_->memory_bytes_ +=
      (law_->press_coordinate_.size() + law_->pull_coordinate_.size()) * sizeof(float);
  for (const law::Law* curve : law_->curves_) measure(*curve);
  law_->range_ = law_->curve()->range();
  law_->site_law_ = std::make_unique<tissue::ElasticField>(
      tissue::ElasticFieldParts{.curves = law_->curves_,
                                .coordinate = law_->press_coordinate_,
                                .pull_coordinate = law_->pull_coordinate_,
                                .surface = scene_.organ_mesh.view(),
                                .relaxation = *relaxation,
                                .neighbours = neighbours(),
                                .damps = law_->damping_Ns_per_m_ > 0.0,
                                .shape = shape});
  return std::nullopt;
}

// The organ of [elastic], with its map where that belongs to this mesh; else the half-space whose
// force under the tip is the law's own at one radius or at the end of its range.
tissue::ElasticNeighbours TissueLawBuilder::neighbours() {
  tissue::ElasticNeighbours out;
  if (!scene_.elastic) {
    const double radius_m = scene_.tool.spheres[0].radius_m;
    const double depth_m = std::min(radius_m, law_->range_.press_m);
    if (const auto unit = law::half_space_under(radius_m, depth_m))
      out.contact_modulus_Pa =
          law_->curve()->respond(depth_m).force_N / unit->respond(depth_m).force_N;
    return out;
  }
  const ElasticSettings& elastic = *scene_.elastic;
  out.youngs_modulus_Pa = elastic.youngs_modulus_Pa;
  out.contact_modulus_Pa =
      elastic.youngs_modulus_Pa / (1.0 - elastic.poisson_ratio * elastic.poisson_ratio);
  out.poisson_ratio = elastic.poisson_ratio;
  if (law_->press_coordinate_.empty()) return out;  // a law that knows no place
  auto map = read_scene_map(scene_);
  if (!map) return out;
  law_->sideways_times_E_per_m_ = tissue::sideways_give(*map, scene_.tool.spheres[0].radius_m);
  out.sideways_times_E_per_m = law_->sideways_times_E_per_m_;
  if (scene_.tool.spheres.size() > 1) {
    law_->rings_times_E_per_m_ = std::move(map->ring_times_E_per_m);
    out.ring_times_E_per_m = law_->rings_times_E_per_m_;
    out.rings = map->rings;
    out.ring_pitch_m = map->ring_pitch_m;
  }
  law_->memory_bytes_ +=
      (law_->rings_times_E_per_m_.size() + law_->sideways_times_E_per_m_.size()) * sizeof(float);
  return out;
}

// The stiffest curve decides what must be rendered.
void TissueLawBuilder::measure(const law::Law& curve) {
  const law::LawRange range = curve.range();
  law_->press_stiffness_N_per_m_ =
      stiffer_N_per_m(law_->press_stiffness_N_per_m_, stiffest_N_per_m(curve, 0.0, range.press_m));
  law_->damping_Ns_per_m_ = std::max(law_->damping_Ns_per_m_, most_damping_Ns_per_m(curve));
  if (range.pull_m < 0.0) {
    law_->pull_limit_N_ = std::max(law_->pull_limit_N_, -curve.respond(range.pull_m).force_N);
    const double torn_m = tear_depth_m(curve, scene_.contact.tear_force_N);
    law_->pull_stiffness_N_per_m_ =
        stiffer_N_per_m(law_->pull_stiffness_N_per_m_, stiffest_N_per_m(curve, torn_m, 0.0));
  }
}

Result<std::unique_ptr<TissueLaw>> make_tissue_law(const Scene& scene, LawKind kind) {
  TissueLawBuilder builder(scene);
  if (auto failed = builder.build(kind)) return *failed;
  return builder.take();
}

}  // namespace tact::model::scene
