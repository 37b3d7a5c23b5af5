#include "model/tissue_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/compliance_family.h"
#include "model/compliance_file.h"
#include "model/elastic_field.h"
#include "model/hex_paper.h"
#include "model/scaled_law.h"
#include "model/tabulated_law.h"

namespace tact::model {
namespace {

constexpr double kRingTolerance = 0.01;  // of the force, where the scene states none

/// The scene's compliance map, which must be of its organ.
Result<ComplianceMap> read_scene_map(const Scene& scene) {
  const std::string cure = "; run tact-condense " + scene.path;
  if (!scene.elastic)
    return Error{scene.path +
                 ": compliance needs a section [elastic]: modulus, Poisson's ratio "
                 "and where the organ is held"};
  auto map = read_compliance_map(scene.compliance.map_path);
  if (!map) return Error{map.error().sentence + cure};
  const ElasticSettings& e = *scene.elastic;
  if (map->mesh_hash != surface_hash(scene.organ_mesh.view()))
    return Error{scene.compliance.map_path + " belongs to another organ mesh" + cure};
  if (map->poisson_ratio != e.poisson_ratio || !(map->fixed_min_m == e.fixed_min_m) ||
      !(map->fixed_max_m == e.fixed_max_m))
    return Error{
        fmt::format("{} was made for Poisson's ratio {} or another held box than [elastic] "
                    "says{}",
                    scene.compliance.map_path, map->poisson_ratio, cure)};
  return map;
}

/// How stiff each vertex is at this depth, over the vertex in the middle of them all.
std::vector<float> stiffness_factors(const ComplianceFamily& family,
                                     const std::vector<float>& coordinate, double depth_m) {
  std::vector<double> curve_N;
  for (const ComplianceCurve& c : family.curve) curve_N.push_back(c.respond(depth_m).force_N);
  std::vector<float> factor;
  for (const float kappa : coordinate) {
    const auto k = std::min(static_cast<std::size_t>(kappa), curve_N.size() - 2);
    const double f = static_cast<double>(kappa) - static_cast<double>(k);
    factor.push_back(static_cast<float>(curve_N[k] + f * (curve_N[k + 1] - curve_N[k])));
  }
  std::vector<float> sorted = factor;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const float median = *middle;
  for (float& f : factor) f /= median;
  return factor;
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
  Result<ComplianceFamily> read_family() const;
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
  law_->title_ = "rhombus chain, energy form";
  auto chain = make_rhombus_chain(scene_.rhombus);
  if (!chain) return blame(chain.error());
  return add_table(keep(std::move(*chain)));
}

// Closed form already: a table would smooth the steps that the discs have.
TissueLawBuilder::Step TissueLawBuilder::add_disc_stack() {
  law_->title_ = scene_.disc_stack.form == DiscForm::kLinear ? "disc stack, linear"
                                                             : "disc stack, Almen-Laszlo";
  auto stack = make_disc_stack(scene_.disc_stack);
  if (!stack) return blame(stack.error());
  auto pulled = with_pull(keep(std::move(*stack)));
  if (!pulled) return pulled.error();
  law_->memory_bytes_ += sizeof(DiscStack);
  return finish_curve(**pulled);
}

TissueLawBuilder::Step TissueLawBuilder::add_hex_sheet() {
  law_->title_ = "hexagonal sheet, energy form";
  auto parameters = scene_.hex_sheet;
  if (parameters.rings == 0) {
    const double tolerance_ratio =
        scene_.tolerance ? scene_.tolerance->force_error_ratio : kRingTolerance;
    auto rings = rings_for_tolerance(parameters, tolerance_ratio);
    if (!rings) return blame(rings.error());
    parameters.rings = *rings;
  }
  auto sheet = make_hex_sheet(parameters);
  if (!sheet) return blame(sheet.error());
  return add_table(keep(std::move(*sheet)));
}

TissueLawBuilder::Step TissueLawBuilder::add_hex_paper() {
  law_->title_ = "hexagonal sheet, as printed";
  const HexSheetParameters& p = scene_.hex_sheet;
  auto sheet = make_hex_paper({.ring_pitch_m = p.ring_pitch_m,
                               .body_stiffness_N_per_m = p.body_stiffness_N_per_m,
                               .rings = p.rings == 0 ? kMaxHexRings : p.rings,
                               .weight = p.weight,
                               .working_depth_m = p.working_depth_m});
  if (!sheet) return blame(sheet.error());
  return add_table(keep(std::move(*sheet)));
}

Result<ComplianceFamily> TissueLawBuilder::read_family() const {
  auto map = read_scene_map(scene_);
  if (!map) return map.error();
  auto family =
      make_compliance_family(*map, {.youngs_modulus_Pa = scene_.elastic->youngs_modulus_Pa,
                                    .tip_radius_m = scene_.tool.spheres[0].radius_m,
                                    .working_depth_m = scene_.compliance.working_depth_m,
                                    .curves = scene_.compliance.curves,
                                    .table_knots = scene_.table_knots});
  if (!family) return blame(family.error());
  return family;
}

TissueLawBuilder::Step TissueLawBuilder::add_compliance() {
  law_->title_ = "linear elastic compliance";
  auto family = read_family();
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
  auto family = read_family();
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
  law_->title_ =
      "mass-spring patch, " + std::string(name_of(scene_.spring_patch.method.integrator));
  SpringPatchParameters parameters = scene_.spring_patch;
  parameters.tick_s = 1.0 / scene_.rate_Hz;
  parameters.spheres = scene_.tool.spheres.size();
  auto relaxation = make_relaxation(scene_.relaxation, parameters.tick_s);
  if (!relaxation) return blame(relaxation.error());
  parameters.relaxation = *relaxation;
  auto patch = make_spring_patch(scene_.organ_mesh.view(), parameters);
  if (!patch) return blame(patch.error());
  law_->range_ = {-parameters.working_depth_m, parameters.working_depth_m};
  law_->stiffness_N_per_m_ = parameters.coupling_stiffness_N_per_m;
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
  constexpr int kSteps = 200;
  const LawRange range = curve.range();
  const bool first = &curve == law_->curves_.front();
  if (first) law_->range_ = range;
  law_->range_.pull_m = std::max(law_->range_.pull_m, range.pull_m);
  law_->range_.press_m = std::min(law_->range_.press_m, range.press_m);
  const double pull_N = range.pull_m < 0.0 ? -curve.respond(range.pull_m).force_N : 0.0;
  law_->pull_limit_N_ = std::max(law_->pull_limit_N_, pull_N);
  for (int i = 0; i <= kSteps; ++i) {
    const double depth_m = range.pull_m + (range.press_m - range.pull_m) * i / kSteps;
    const LawResponse r = curve.respond(depth_m);
    if (r.force_N < -scene_.contact.tear_force_N) continue;  // lets go before
    law_->stiffness_N_per_m_ = std::max(law_->stiffness_N_per_m_, r.stiffness_N_per_m);
  }
}

Result<std::unique_ptr<TissueLaw>> make_tissue_law(const Scene& scene, LawKind kind) {
  TissueLawBuilder builder(scene);
  if (auto failed = builder.build(kind)) return *failed;
  return builder.take();
}

}  // namespace tact::model
