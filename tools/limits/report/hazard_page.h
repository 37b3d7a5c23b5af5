// SPDX-License-Identifier: Apache-2.0
// hazard_page.h - the matrix hazard, requirement, stage and fault, test of a report: for the page
// and for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/limits/report/report.h"

namespace tact::tools::limits {

/// For the template: strings, truth, lists and objects alone.
nlohmann::json matrix_data(const LimitsReport& report);
/// What shows the requirements, by name: the annex of that matrix.
nlohmann::json tests_data(const LimitsReport& report);
/// Both for limits.json.
nlohmann::json hazards_json(const LimitsReport& report);

}  // namespace tact::tools::limits
