// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_law.h"

#include <algorithm>
#include <cmath>

#include "model/indent/disc_stack.h"
#include "model/reader/scene_text.h"
#include "model/scene/laws.h"
#include "model/springs/spring_patch.h"

namespace tact::tools::fit {
namespace {

using model::indent::DiscForm;
using model::indent::DiscStackParameters;
using model::scene::LawRow;
using model::scene::Scene;
using model::springs::SpringPatchParameters;

constexpr double kNothing_ratio = 1e-8;  // of a range: replaces 0, which has no logarithm
constexpr double kSteepestCone = 0.4;    // eta: beyond, layers can be felt one by one
constexpr double kFlattestCone = 0.02;
constexpr double kTableReach_ratio =
    0.95;  // share of the working depth that is felt (tabulated_law.h)

/// With the range of the scene. A quantity with the newton in its unit multiplies the force.
FitParameter fitted(std::string_view section, const model::Parameter& p,
                    std::function<double&(Scene&)> in) {
  const std::string_view unit = model::io::unit_of(p.key);
  return {.section = std::string(section),
          .key = std::string(p.key),
          .low = p.range.low > 0.0 ? p.range.low : kNothing_ratio * p.range.high,
          .high = p.range.high,
          .in = std::move(in),
          .is_stiffness = unit == "N" || unit == "N/m" || unit == "Pa"};
}

FitParameter fitted(const LawRow& row, std::string_view key) {
  Scene any;
  return fitted(row.name, parameters_of(row, any).find(key), [&row, key](Scene& s) -> double& {
    return *parameters_of(row, s).find(key).number;
  });
}

FitLaw law_of(const LawRow& row) {
  FitLaw law{.name = std::string(row.name),
             .law = std::string(row.name),
             .by_place = row.curve == nullptr,
             .starts = row.fit_starts};
  for (const std::string_view key : row.fit_keys) law.parameters.push_back(fitted(row, key));
  if (law.starts.empty()) law.starts.emplace_back(law.parameters.size(), 1.0);
  return law;
}

FitLaw disc_stack(const LawRow& row, DiscForm form) {
  FitLaw law = law_of(row);
  law.name += form == DiscForm::kLinear ? "_linear" : "_almen_laszlo";
  law.choice = "form = \"" + std::string(name_of(form)) + "\"";
  law.follow = [form](Scene& s) { s.laws.of<DiscStackParameters>().form = form; };
  return law;
}

/// Travel is fitted too, as the height that the scene writes.
FitLaw coned_disc_stack(const LawRow& row, const Scene& scene) {
  FitLaw law = disc_stack(row, DiscForm::kAlmenLaszlo);
  const auto& disc = scene.laws.of<DiscStackParameters>().disc;
  FitParameter height = fitted(row, "free_height_m");
  height.low = (1.0 + kFlattestCone) * disc.thickness_m;
  height.high = (1.0 + kSteepestCone) * disc.thickness_m;
  law.parameters.push_back(std::move(height));
  // each height has its own texture and its own local minimum: begin at many
  constexpr int kHeights = 12;
  law.starts.clear();
  for (int i = 0; i < kHeights; ++i) {
    const double cone = kFlattestCone + (kSteepestCone - kFlattestCone) * (i + 0.5) / kHeights;
    law.starts.push_back({1, (1.0 + cone) * disc.thickness_m / disc.free_height_m});
  }
  return law;
}

FitLaw compliance(const LawRow& row) {
  FitLaw law = law_of(row);
  model::scene::ElasticSettings any;
  law.parameters = {fitted("elastic", model::parameters_of(any).find("youngs_modulus_Pa"),
                           [](Scene& s) -> double& { return s.elastic->youngs_modulus_Pa; })};
  law.starts = {{1}};
  return law;
}

// Settled by stepping, so a slope needs a longer step than a closed form does.
FitLaw spring_patch(const LawRow& row, const Scene& scene) {
  FitLaw law = law_of(row);
  law.difference = 0.02;
  law.most_evaluations = 60;
  law.is_slow = true;
  law.followers = {fitted(row, "node_mass_kg")};
  const auto stiffest = [](const SpringPatchParameters& p) {
    return p.tissue.surface_stiffness_N_per_m + p.tissue.body_stiffness_N_per_m +
           p.coupling_stiffness_N_per_m;
  };
  const auto& own = scene.laws.of<SpringPatchParameters>();
  law.follow = [mass = law.followers[0], mass_kg = own.node_mass_kg, before = stiffest(own),
                stiffest](Scene& s) {
    // Mass in proportion to the springs: the ticks to rest, and the step's stability, stay as they
    // are.
    const double wanted_kg = mass_kg * stiffest(s.laws.of<SpringPatchParameters>()) / before;
    mass.in(s) = std::clamp(wanted_kg, mass.low, mass.high);
  };
  return law;
}

/// Not of the press, whose stiffnesses are scaled together.
FitParameter pull() {
  model::law::LinearPullParameters any;
  FitParameter out = fitted("pull", model::parameters_of(any).find("stiffness_N_per_m"),
                            [](Scene& s) -> double& { return s.pull->stiffness_N_per_m; });
  out.is_stiffness = false;
  return out;
}

/// Nothing where the scene does not describe the law, or its row has no keys to fit.
std::vector<FitLaw> laws_of(const LawRow& row, const Scene& scene) {
  if (!scene.describes(row.name)) return {};
  if (row.name == "disc_stack")
    return {disc_stack(row, DiscForm::kLinear), coned_disc_stack(row, scene)};
  if (row.name == "compliance") return {compliance(row)};
  if (row.name == "spring_patch") return {spring_patch(row, scene)};
  if (row.fit_keys.empty()) return {};
  return {law_of(row)};
}

}  // namespace

std::vector<FitLaw> fit_laws_of(const Scene& scene, const FitData& data) {
  std::vector<FitLaw> laws;
  for (const LawRow& row : model::scene::all_laws())
    for (FitLaw& law : laws_of(row, scene)) {
      if (!law.by_place && data.farthest_pull_m() > 0.0) {
        law.parameters.push_back(pull());
        for (std::vector<double>& start : law.starts) start.push_back(1.0);
      }
      laws.push_back(std::move(law));
    }
  return laws;
}

std::size_t keep_parameters(FitLaw& law, const std::vector<std::string>& names) {
  std::size_t kept = 0;
  for (std::size_t i = law.parameters.size(); i-- > 0;) {
    const FitParameter& p = law.parameters[i];
    const bool is_kept = std::any_of(names.begin(), names.end(), [&p](const std::string& name) {
      return name == p.key || name == p.section + "." + p.key;
    });
    if (!is_kept) continue;
    const auto at = static_cast<std::ptrdiff_t>(i);
    law.parameters.erase(law.parameters.begin() + at);
    // Backwards, so that the places of those still to be looked at stay.
    for (std::vector<double>& start : law.starts) start.erase(start.begin() + at);
    ++kept;
  }
  return kept;
}

void reach(Scene& scene, const FitData& data) {
  const double deepest_m = std::max(data.deepest_m(), data.farthest_pull_m());
  // Up to a tenth of a millimetre: a number that reads well in a scene.
  const double needed_m = std::ceil(deepest_m / kTableReach_ratio * 1e4) * 1e-4;
  for (const LawRow& row : model::scene::all_laws())
    if (double* working_depth_m = parameters_of(row, scene).find("working_depth_m").number)
      *working_depth_m = std::max(*working_depth_m, needed_m);
  if (!(data.farthest_pull_m() > 0.0)) return;
  if (scene.pull) {
    scene.pull->limit_m = std::max(scene.pull->limit_m, data.farthest_pull_m());
    return;
  }
  // Bonded tissue is linear in pull: the least squares of F = k d.
  double sum_fd = 0.0, sum_dd = 0.0;
  for (const FitSite& site : data.sites)
    for (const FitSample& s : site.samples)
      if (s.depth_m < 0.0) sum_fd += s.force_N * s.depth_m, sum_dd += s.depth_m * s.depth_m;
  scene.pull = {.stiffness_N_per_m = std::clamp(sum_fd / sum_dd, pull().low, pull().high),
                .limit_m = std::max(model::kDepth_m.low, data.farthest_pull_m())};
}

}  // namespace tact::tools::fit
