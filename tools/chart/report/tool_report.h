// SPDX-License-Identifier: Apache-2.0
// tool_report.h - what the whole tool's laws are worth, as files and as text.
#pragma once

#include <string>
#include <vector>

#include "model/scene/accuracy_file.h"
#include "tools/chart/compare/chart.h"
#include "tools/chart/compare/tool_check.h"

namespace tact::tools::chart {

/// One row for each law, place and depth.
report::Table tool_table(const std::vector<ToolRow>& rows,
                         const ground_truth::ToolReference& reference);

/// The JSON of tool.json: where it comes from, a summary of each law, and the table.
std::string tool_json(const std::vector<ToolRow>& rows,
                      const ground_truth::ToolReference& reference, const std::string& command,
                      const Provenance& provenance);

/// What tactd --check may report of each law that was measured. An error names a law that cannot be
/// made.
model::Result<std::vector<model::scene::Accuracy>> accuracy_of(
    const model::scene::Scene& scene, const std::vector<ToolRow>& rows,
    const ground_truth::ToolReference& reference);

/// For a terminal: each law, then its own error at each place and depth.
std::string tool_text(const std::vector<ToolRow>& rows,
                      const ground_truth::ToolReference& reference);

}  // namespace tact::tools::chart
