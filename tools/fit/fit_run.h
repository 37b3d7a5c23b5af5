// SPDX-License-Identifier: Apache-2.0
// fit_run.h - fits one law to data: turns its parameters until the residual is least.
//
//     minimise  sum over fitted samples of (e / peak)^2  +  (w e_shape)^2
//
//     e        force error, N; with a factor for each site, after the best factor     peak  N
//     e_shape  RMS error of the shape over the rings, of the depth     w  weight, 0.1 by default
//
// With factors, their geometric mean over the fitted sites is 1; a held-out site is evaluated with
// its own best factor: what it tests is the form of the curve alone.
// So an error of the shape of 10 % of the depth counts like one of the force of 1 % of the peak.
// From several fixed starts, each first scaled to the force of the data: a short search from each,
// a long one from the best. What is reported is the law as the loop renders it.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "tools/fit/fit_check.h"
#include "tools/fit/fit_law.h"

namespace tact::tools::fit {

struct FitOptions {
  double shape_weight = 0.1;
  bool scale_by_site = false;
};

/// A number of the scene after the fit.
struct FittedKey {
  std::string section, key;
  double value = 0.0;
  bool at_bound = false;  // the data wants it beyond the scene's range
};

struct FittedLaw {
  std::string name;
  std::string title{};   // for people
  std::string choice{};  // as FitLaw
  std::vector<FittedKey> keys{};
  Evaluation checked{};
  std::vector<FitAnswer> answers{};  // in the order of the data, before factors of sites
  int evaluations = 0;
};

/// An error says why there is no such law, or why the data does not suit it.
model::Result<FittedLaw> fit_law(const FitLaw& law, const model::scene::Scene& scene,
                                 const FitData& data, const FitOptions& options);

}  // namespace tact::tools::fit
