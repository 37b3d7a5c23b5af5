// SPDX-License-Identifier: Apache-2.0
// report.h - the chart as files and as text: CSV and JSON that say where they come from.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "tools/chart/compare/chart.h"

namespace tact::tools::chart {

/// "# command: ..." and so on: how to make these numbers again. Ends in a line end.
std::string csv_head(const std::string& command, const Provenance& provenance);

/// The document of chart.json and of --json: tools/schema/tact-chart.schema.json.
std::string chart_json(const report::Table& table, const std::string& command,
                       const Provenance& provenance);
/// chart.csv and chart.json.
model::Result<std::vector<std::string>> write_chart(const report::Table& table,
                                                    const std::string& command,
                                                    const Provenance& provenance,
                                                    const std::string& directory);

/// The rows of a chart.json.
model::Result<report::Table> read_chart(const std::string& path);
/// `laws`, and behind them the rows of kind "peer" of another chart.json, each with the revision
/// and machine that it was measured on. An error: they were measured against another reference.
model::Result<report::Table> with_peers(const report::Table& laws, const std::string& path,
                                        const std::string& reference_hash);
/// Where and when the peers were measured, for text and picture; empty without peers.
std::string source_of_peers(const report::Table& table);

/// Draws chart.svg and chart.png of a whole table; returns their paths.
model::Result<std::vector<std::string>> draw_chart(const report::Table& table,
                                                   const std::string& title,
                                                   const std::string& directory);

/// For a terminal; the front is marked.
std::string chart_text(const report::Table& table);

}  // namespace tact::tools::chart
