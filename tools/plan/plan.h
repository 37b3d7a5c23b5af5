// SPDX-License-Identifier: Apache-2.0
// plan.h - what tact-lab plan chooses from: the candidates of a chart, if it is of this scene and
// machine.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "tools/chart/compare/chart.h"
#include "tools/plan/choose.h"

namespace tact::tools::plan {

/// Tact's rows of a chart; those that could not be measured are left out.
std::vector<Candidate> candidates_of(const report::Table& table);

/// An error if the chart is of another scene or another machine: then its times say nothing here.
std::optional<model::Error> check_chart_fits(const report::Table& table,
                                             const model::scene::Scene& scene,
                                             const std::string& path);

/// What a blade cannot cut is no choice for a scene with one.
void keep_what_cuts(std::vector<Candidate>& candidates);

}  // namespace tact::tools::plan
