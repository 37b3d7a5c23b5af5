// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_law.h"

#include <algorithm>
#include <cmath>

namespace tact::tools::fit {
namespace {

using model::indent::DiscForm;
using model::scene::LawKind;
using model::scene::Scene;

constexpr double kMin_N_per_m = 1e-3;  // stands for no spring
constexpr double kMax_N_per_m = 1e5;
constexpr double kSteepestCone = 0.4;  // eta: beyond, layers can be felt one by one
constexpr double kFlattestCone = 0.02;
constexpr double kTableReach = 0.95;  // share of the working depth that is felt (tabulated_law.h)

FitParameter spring(const char* section, const char* key, std::function<double&(Scene&)> in) {
  return {.section = section,
          .key = key,
          .low = kMin_N_per_m,
          .high = kMax_N_per_m,
          .in = std::move(in),
          .is_stiffness = true};
}

FitLaw rhombus() {
  const auto p = [](Scene& s) -> model::indent::RhombusChainParameters& { return s.rhombus; };
  FitLaw law{.name = "rhombus", .kind = LawKind::kRhombus};
  law.parameters = {
      {"rhombus", "rod_length_m", 1e-4, 0.1,
       [p](Scene& s) -> double& { return p(s).rod_length_m; }},
      {"rhombus", "initial_angle_rad", 0.05, 1.5,
       [p](Scene& s) -> double& { return p(s).initial_angle_rad; }},
      spring("rhombus", "normal_stiffness_N_per_m",
             [p](Scene& s) -> double& { return p(s).normal_stiffness_N_per_m; }),
      spring("rhombus", "tangential_stiffness_N_per_m",
             [p](Scene& s) -> double& { return p(s).tangential_stiffness_N_per_m; }),
      {"rhombus", "growth", 0.1, 100.0, [p](Scene& s) -> double& { return p(s).growth; }}};
  // Without its normal springs the chain would carry nothing at rest.
  law.parameters[2].low = 0.01;
  // Chosen: as the scene, steeper, and with the tangential springs strong or nearly away.
  law.starts = {{1, 1, 1, 1, 1}, {1, 1.8, 1, 1, 1}, {0.5, 2.4, 1, 5, 3}, {2, 1, 1, 0.1, 1}};
  return law;
}

FitLaw disc_stack(DiscForm form) {
  const bool is_linear = form == DiscForm::kLinear;
  FitLaw law{.name = is_linear ? "disc_stack_linear" : "disc_stack_almen_laszlo",
             .kind = LawKind::kDiscStack,
             .choice = is_linear ? "form = \"linear\"" : "form = \"almen-laszlo\""};
  law.parameters = {{"disc_stack", "youngs_modulus_Pa", 1.0, 1e13,
                     [](Scene& s) -> double& { return s.disc_stack.disc.youngs_modulus_Pa; },
                     true}};
  law.starts = {{1}};
  law.follow = [form](Scene& s) { s.disc_stack.form = form; };
  return law;
}

/// Travel is fitted too, as the height that the scene writes.
FitLaw coned_disc_stack(const Scene& scene) {
  FitLaw law = disc_stack(DiscForm::kAlmenLaszlo);
  const double thickness_m = scene.disc_stack.disc.thickness_m;
  law.parameters.push_back({"disc_stack", "free_height_m", (1.0 + kFlattestCone) * thickness_m,
                            (1.0 + kSteepestCone) * thickness_m,
                            [](Scene& s) -> double& { return s.disc_stack.disc.free_height_m; }});
  // each height has its own texture and its own local minimum: begin at many
  constexpr int kHeights = 12;
  const double now_m = scene.disc_stack.disc.free_height_m;
  law.starts.clear();
  for (int i = 0; i < kHeights; ++i) {
    const double cone = kFlattestCone + (kSteepestCone - kFlattestCone) * (i + 0.5) / kHeights;
    law.starts.push_back({1, (1.0 + cone) * thickness_m / now_m});
  }
  return law;
}

FitLaw hex_sheet() {
  const auto p = [](Scene& s) -> model::indent::HexSheetParameters& { return s.hex_sheet; };
  FitLaw law{.name = "hex_sheet", .kind = LawKind::kHexSheet};
  law.parameters = {{"hex_sheet", "ring_pitch_m", 1e-4, 0.05,
                     [p](Scene& s) -> double& { return p(s).ring_pitch_m; }},
                    spring("hex_sheet", "body_stiffness_N_per_m",
                           [p](Scene& s) -> double& { return p(s).body_stiffness_N_per_m; })};
  law.parameters[1].low = 0.01;
  law.parameters.push_back(
      spring("hex_sheet", "contact_stiffness_N_per_m",
             [p](Scene& s) -> double& { return p(s).contact_stiffness_N_per_m; }));
  law.parameters.push_back(
      spring("hex_sheet", "surface_stiffness_N_per_m",
             [p](Scene& s) -> double& { return p(s).surface_stiffness_N_per_m; }));
  law.parameters.push_back({"hex_sheet", "tension_N", 1e-6, 100.0,
                            [p](Scene& s) -> double& { return p(s).tension_N; }, true});
  law.starts = {{1, 1, 1, 1, 1}, {2, 1, 1, 1, 3}, {1, 0.1, 1, 3, 1}, {0.5, 1, 10, 10, 0.3}};
  return law;
}

/// The dissipation stays: data of a slow press does not tell it.
FitLaw hunt_crossley() {
  FitLaw law{.name = "hunt_crossley", .kind = LawKind::kHuntCrossley};
  law.parameters = {{"hunt_crossley", "force_N", 1e-4, 100.0,
                     [](Scene& s) -> double& { return s.hunt_crossley.force_N; }, true},
                    {"hunt_crossley", "exponent", 1.0, 4.0,
                     [](Scene& s) -> double& { return s.hunt_crossley.exponent; }}};
  law.starts = {{1, 1}, {1, 1.3}};
  return law;
}

FitLaw compliance() {
  FitLaw law{.name = "compliance", .kind = LawKind::kCompliance, .by_place = true};
  law.parameters = {{"elastic", "youngs_modulus_Pa", 1.0, 1e9,
                     [](Scene& s) -> double& { return s.elastic->youngs_modulus_Pa; }, true}};
  law.starts = {{1}};
  return law;
}

// Settled by stepping, so a slope needs a longer step than a closed form does.
FitLaw spring_patch(const Scene& scene) {
  const auto p = [](Scene& s) -> model::springs::SpringPatchParameters& { return s.spring_patch; };
  FitLaw law{.name = "spring_patch",
             .kind = LawKind::kSpringPatch,
             .by_place = true,
             .difference = 0.02,
             .most_evaluations = 60,
             .is_slow = true};
  law.parameters = {
      spring("spring_patch", "surface_stiffness_N_per_m",
             [p](Scene& s) -> double& { return p(s).tissue.surface_stiffness_N_per_m; }),
      spring("spring_patch", "body_stiffness_N_per_m",
             [p](Scene& s) -> double& { return p(s).tissue.body_stiffness_N_per_m; }),
      spring("spring_patch", "coupling_stiffness_N_per_m",
             [p](Scene& s) -> double& { return p(s).coupling_stiffness_N_per_m; })};
  for (FitParameter& parameter : law.parameters) parameter.low = 0.01;
  law.starts = {{1, 1, 1}};
  law.followers = {{"spring_patch", "node_mass_kg", 1e-7, 1.0,
                    [p](Scene& s) -> double& { return p(s).node_mass_kg; }}};
  const auto stiffest = [](const Scene& s) {
    const model::springs::SpringPatchParameters& q = s.spring_patch;
    return q.tissue.surface_stiffness_N_per_m + q.tissue.body_stiffness_N_per_m +
           q.coupling_stiffness_N_per_m;
  };
  law.follow = [mass_kg = scene.spring_patch.node_mass_kg, before = stiffest(scene),
                stiffest](Scene& s) {
    // Mass in proportion to the springs: the ticks to rest, and the step's stability, stay as they
    // are.
    s.spring_patch.node_mass_kg = std::clamp(mass_kg * stiffest(s) / before, 1e-7, 1.0);
  };
  return law;
}

}  // namespace

std::vector<FitLaw> fit_laws_of(const Scene& scene, const FitData& data) {
  std::vector<FitLaw> laws;
  if (scene.describes(LawKind::kRhombus)) laws.push_back(rhombus());
  if (scene.describes(LawKind::kDiscStack)) {
    laws.push_back(disc_stack(DiscForm::kLinear));
    laws.push_back(coned_disc_stack(scene));
  }
  if (scene.describes(LawKind::kHexSheet)) laws.push_back(hex_sheet());
  if (scene.describes(LawKind::kHuntCrossley)) laws.push_back(hunt_crossley());
  if (data.farthest_pull_m() > 0.0) {
    for (FitLaw& law : laws) {
      law.parameters.push_back({"pull", "stiffness_N_per_m", 0.01, 1e5,
                                [](Scene& s) -> double& { return s.pull->stiffness_N_per_m; }});
      for (std::vector<double>& start : law.starts) start.push_back(1.0);
    }
  }
  if (scene.describes(LawKind::kCompliance)) laws.push_back(compliance());
  if (scene.describes(LawKind::kSpringPatch)) laws.push_back(spring_patch(scene));
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
  for (double* working_depth_m :
       {&scene.hex_sheet.working_depth_m, &scene.hunt_crossley.working_depth_m,
        &scene.compliance.working_depth_m, &scene.spring_patch.working_depth_m}) {
    // Up to a tenth of a millimetre: a number that reads well in a scene.
    const double needed_m = std::ceil(deepest_m / kTableReach * 1e4) * 1e-4;
    *working_depth_m = std::max(*working_depth_m, needed_m);
  }
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
  scene.pull = {.stiffness_N_per_m = std::clamp(sum_fd / sum_dd, 0.01, 1e5),
                .limit_m = std::max(1e-4, data.farthest_pull_m())};
}

}  // namespace tact::tools::fit
