// SPDX-License-Identifier: Apache-2.0
// fit_law.h - which numbers of a scene make a law, so that a fit can turn them.
//
// A fit changes the numbers in a Scene and lets make_tissue_law build the law from it, as tactd
// does. Which numbers, and where the search starts, is in the row of the law
// (model/scene/laws.cc); bounds are the scene's ranges, from the least above 0. What no row says:
//
//     disc_stack   in two forms; almen-laszlo: also free_height_m, up to eta = 0.4
//     compliance   elastic.youngs_modulus_Pa: the shape of the organ is known
//     spring_patch the mass keeps its ratio to the springs
//     pull         stiffness, beside every law that has one curve, when the data pulls
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "model/scene/scene.h"
#include "tools/fit/fit_data.h"

namespace tact::tools::fit {

struct FitParameter {
  std::string section, key;  // in the scene
  double low = 0.0, high = 0.0;
  std::function<double&(model::scene::Scene&)> in;
  /// Multiplied all together they multiply the force in press, and leave the shape.
  bool is_stiffness = false;
};

struct FitLaw {
  std::string name;             // as --law takes it
  std::string law{};            // as a scene names it
  bool by_place = false;        // differs from place to place
  std::string choice{};         // key = "word" of its section that makes this law, or empty
  double difference = 1e-4;     // of a slope, in the logarithm
  int most_evaluations = 2000;  // of the long search; a tenth from every start before
  bool is_slow = false;         // fitted to the deepest samples of a site and those half as deep
  std::vector<FitParameter> parameters{};
  /// Ratios to the scene's own numbers where the search starts, one vector each.
  std::vector<std::vector<double>> starts{};
  /// Numbers that follow from the fitted ones, and a choice of form.
  std::function<void(model::scene::Scene&)> follow{};
  /// Parameters that follow() turns and that belong into the scene too.
  std::vector<FitParameter> followers{};
};

/// The laws that the scene describes, for data like this; names are unique.
std::vector<FitLaw> fit_laws_of(const model::scene::Scene& scene, const FitData& data);

/// Takes parameters out of the search: those named here, by "key" or "section.key", stay as the
/// scene has them. Returns how many were taken out.
std::size_t keep_parameters(FitLaw& law, const std::vector<std::string>& names);

/// Raises working depths and the limit of the pull to what the data needs.
void reach(model::scene::Scene& scene, const FitData& data);

}  // namespace tact::tools::fit
