// SPDX-License-Identifier: Apache-2.0
// fit_answer.h - what a scene's law answers where the data was measured.
//
// Quasi-static: every sample is asked from rest, without relaxation; a stepped law (spring_patch)
// is ticked until its force is constant. The shape is linear between the law's rings, zero beyond
// the last; of a stepped law it is the mean of the vertices near each radius.
#pragma once

#include <string_view>
#include <vector>

#include "model/result.h"
#include "model/scene/scene.h"
#include "tools/fit/fit_data.h"

namespace tact::tools::fit {

struct FitAnswer {
  double force_N = 0.0;
  std::vector<double> ring_m{};  // at the radii of the data; NaN: not known
};

/// As the loop renders it, from its tables; or, where a search asks thousands of times for a few
/// depths, the closed form solved at these depths alone (the same within 1e-6).
enum class AnswerBy { kLoop, kSolving };

/// One answer a sample, in the order of sites and samples. An error says why there is no such law.
model::Result<std::vector<FitAnswer>> answers_of(const model::scene::Scene& scene,
                                                 std::string_view law_name, const FitData& data,
                                                 AnswerBy by = AnswerBy::kLoop);

}  // namespace tact::tools::fit
