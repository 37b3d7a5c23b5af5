#include "model/tissue_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/compliance_family.h"
#include "model/elastic_field.h"
#include "model/hex_paper.h"
#include "model/scaled_law.h"
#include "model/tabulated_law.h"
#include "model/tissue_map.h"

namespace tact::model {
namespace {

constexpr double kRingTolerance = 0.01;  // of the force, where the scene states none

/// NaN is the stiffest of all, so that what must bound it refuses it.
double stiffer_N_per_m(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

/// Largest slope between two depths; those at the ends are seen from inside.
double stiffest_N_per_m(const Law& law, double from_m, double to_m) {
  constexpr int kSteps = 200;
  double most_N_per_m = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double ratio = std::clamp(static_cast<double>(i) / kSteps, 1e-6, 1.0 - 1e-6);
    const LawResponse r = law.respond(from_m + ratio * (to_m - from_m));
    most_N_per_m = stiffer_N_per_m(most_N_per_m, r.stiffness_N_per_m);
  }
  return most_N_per_m;
}

/// How far out a held site comes before it tears, or the end of the law's range, m, <= 0.
double tear_depth_m(const Law& law, double tear_force_N) {
  const auto holds = [&](double depth_m) { return law.respond(depth_m).force_N >= -tear_force_N; };
  double torn_m = law.range().pull_m, held_m = 0.0;
  if (holds(torn_m)) return torn_m;
  for (int i = 0; i < 50; ++i) {
    const double middle_m = 0.5 * (torn_m + held_m);
    (holds(middle_m) ? held_m : torn_m) = middle_m;
  }
  return torn_m;
}

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
  Step add_hex_paper();
  Step add_compliance();
  Step add_spring_patch();
  Step add_table(const Law& direct);
  Result<const Law*> with_pull(const Law& press);
  Step finish_curve(const Law& curve);
  Step scale_by_place(const Law& curve);
  Step finish_field();
  void measure(const Law& curve);

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
    case LawKind::kHexSheetPaper:
      return add_hex_paper();
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
  return add_table(keep(std::move(*chain)));
}

// Closed form already: a table would smooth the steps that the discs have.
TissueLawBuilder::Step TissueLawBuilder::add_disc_stack() {
  auto stack = make_disc_stack(scene_.disc_stack);
  if (!stack) return blame(stack.error());
  law_->title_ =
      fmt::format("disc stack, {}, {} layers",
                  scene_.disc_stack.form == DiscForm::kLinear ? "linear" : "Almen-Laszlo",
                  stack->layer_count());
  auto pulled = with_pull(keep(std::move(*stack)));
  if (!pulled) return pulled.error();
  law_->memory_bytes_ += sizeof(DiscStack);
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
  return add_table(keep(std::move(*sheet)));
}

TissueLawBuilder::Step TissueLawBuilder::add_hex_paper() {
  const HexSheetParameters& p = scene_.hex_sheet;
  const std::size_t rings = p.rings == 0 ? kMaxHexRings : p.rings;
  law_->title_ = fmt::format("hexagonal sheet, as printed, {} rings", rings);
  auto sheet = make_hex_paper({.ring_pitch_m = p.ring_pitch_m,
                               .body_stiffness_N_per_m = p.body_stiffness_N_per_m,
                               .rings = rings,
                               .weight = p.weight,
                               .working_depth_m = p.working_depth_m});
  if (!sheet) return blame(sheet.error());
  return add_table(keep(std::move(*sheet)));
}

TissueLawBuilder::Step TissueLawBuilder::add_compliance() {
  law_->title_ = fmt::format("linear elastic compliance, {} curves", scene_.compliance.curves);
  auto family = read_scene_family(scene_);
  if (!family) return family.error();
  for (ComplianceCurve& curve : family->curve) law_->curves_.push_back(&keep(std::move(curve)));
  law_->press_coordinate_ = std::move(family->press_coordinate);
  law_->pull_coordinate_ = std::move(family->pull_coordinate);
  law_->memory_bytes_ += law_->curves_.size() * sizeof(ComplianceCurve);
  return finish_field();
}

/// One law everywhere, or scaled from place to place.
TissueLawBuilder::Step TissueLawBuilder::finish_curve(const Law& curve) {
  if (scene_.varies_by_place) return scale_by_place(curve);
  law_->curves_.push_back(&curve);
  return finish_field();
}

// Energies are linear in the factor, so two curves are enough: the softest and the stiffest place.
TissueLawBuilder::Step TissueLawBuilder::scale_by_place(const Law& curve) {
  auto family = read_scene_family(scene_);
  if (!family) return family.error();
  const double depth_m = 0.5 * scene_.compliance.working_depth_m;
  std::vector<float> press = stiffness_factors(*family, family->press_coordinate, depth_m);
  std::vector<float> pull = stiffness_factors(*family, family->pull_coordinate, -depth_m);
  const auto [press_low, press_high] = std::minmax_element(press.begin(), press.end());
  const auto [pull_low, pull_high] = std::minmax_element(pull.begin(), pull.end());
  const float low = std::min(*press_low, *pull_low), high = std::max(*press_high, *pull_high);
  const float span = high > low ? high - low : 1.0F;
  for (std::vector<float>* factors : {&press, &pull})
    for (float& f : *factors) f = (f - low) / span;
  law_->title_ += ", scaled by place";
  law_->curves_ = {&keep(ScaledLaw(curve, static_cast<double>(low))),
                   &keep(ScaledLaw(curve, static_cast<double>(low + span)))};
  law_->press_coordinate_ = std::move(press);
  law_->pull_coordinate_ = std::move(pull);
  return finish_field();
}

// The hand meets no more than the virtual spring, whatever the nodes do in one tick.
TissueLawBuilder::Step TissueLawBuilder::add_spring_patch() {
  const std::size_t nodes = std::min(scene_.spring_patch.nodes, scene_.organ_mesh.vertex_m.size());
  law_->title_ = fmt::format("mass-spring patch, {} nodes, {}", nodes,
                             name_of(scene_.spring_patch.method.integrator));
  SpringPatchParameters parameters = scene_.spring_patch;
  parameters.tick_s = 1.0 / scene_.rate_Hz;
  parameters.spheres = scene_.tool.spheres.size();
  auto relaxation = make_relaxation(scene_.relaxation, parameters.tick_s);
  if (!relaxation) return blame(relaxation.error());
  parameters.relaxation = *relaxation;
  auto patch = make_spring_patch(scene_.organ_mesh.view(), parameters);
  if (!patch) return blame(patch.error());
  law_->range_ = {-parameters.working_depth_m, parameters.working_depth_m};
  law_->press_stiffness_N_per_m_ = parameters.coupling_stiffness_N_per_m;
  law_->memory_bytes_ = (*patch)->memory_bytes();
  law_->site_law_ = std::move(*patch);
  return std::nullopt;
}

/// Press as the law gives it, pull as [pull] says.
Result<const Law*> TissueLawBuilder::with_pull(const Law& press) {
  if (!scene_.pull) return &press;
  auto pulled = make_linear_pull(press, *scene_.pull);
  if (!pulled) return blame(pulled.error());
  return &keep(std::move(*pulled));
}

TissueLawBuilder::Step TissueLawBuilder::add_table(const Law& direct) {
  auto law = with_pull(direct);
  if (!law) return law.error();
  auto table = tabulate(**law, scene_.table_knots);
  if (!table) return blame(table.error());
  law_->memory_bytes_ += sizeof(TabulatedLaw);
  return finish_curve(keep(std::move(*table)));
}

TissueLawBuilder::Step TissueLawBuilder::finish_field() {
  auto relaxation = make_relaxation(scene_.relaxation, 1.0 / scene_.rate_Hz);
  if (!relaxation) return blame(relaxation.error());
  law_->memory_bytes_ +=
      (law_->press_coordinate_.size() + law_->pull_coordinate_.size()) * sizeof(float);
  for (const Law* curve : law_->curves_) measure(*curve);
  law_->site_law_ =
      std::make_unique<ElasticField>(ElasticFieldParts{.curves = law_->curves_,
                                                       .coordinate = law_->press_coordinate_,
                                                       .pull_coordinate = law_->pull_coordinate_,
                                                       .surface = scene_.organ_mesh.view(),
                                                       .relaxation = *relaxation});
  return std::nullopt;
}

// The stiffest curve decides what must be rendered, the narrowest range what is valid everywhere.
void TissueLawBuilder::measure(const Law& curve) {
  const LawRange range = curve.range();
  const bool first = &curve == law_->curves_.front();
  if (first) law_->range_ = range;
  law_->range_.pull_m = std::max(law_->range_.pull_m, range.pull_m);
  law_->range_.press_m = std::min(law_->range_.press_m, range.press_m);
  law_->press_stiffness_N_per_m_ =
      stiffer_N_per_m(law_->press_stiffness_N_per_m_, stiffest_N_per_m(curve, 0.0, range.press_m));
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

}  // namespace tact::model
