// SPDX-License-Identifier: Apache-2.0
// chart.h - speed against accuracy: one row for every law and size of a scene. Rows of kind "peer",
// other ways to do the same, come from a file alone (report.h).
//
// First all rows are made and evaluated on all cores, then timed one after the other, so that they
// do not disturb each other. The errors are the same on every machine; times belong to the row's
// machine. The time of a law is the tick that a user gets: detect, render and limit of the scene's
// whole tool (tool_check.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/scene/plan_file.h"
#include "tools/chart/compare/tool_check.h"
#include "tools/chart/measure/measure.h"
#include "tools/program/sweep.h"
#include "tools/report/table.h"

namespace tact::tools::chart {

struct Variant {
  model::scene::LawSizes sizes{};

  std::string size() const;  // "65 knots"
};

struct VariantRequest {
  std::vector<std::string> laws;  // families; empty: all
  bool quick = false;             // fewer sizes
};

/// In the order of the table. Laws that the scene does not describe are left out.
std::vector<Variant> variants_of(const model::scene::Scene& scene, const VariantRequest& request);
/// Those that the scene describes: others would be measured with numbers of no scene.
std::vector<std::string> wanted_laws(const model::scene::Scene& scene,
                                     const VariantRequest& request);
/// Every family there is, for --laws.
std::vector<std::string> all_families();

struct ChartRow {
  Variant variant{};
  std::string failure{};             // empty: it was measured
  ErrorSummary errors{};             // of one sphere
  std::optional<ToolErrors> tool{};  // of the whole tool; none: no reference
  int settle_ticks = 0;
  Timing timing{};
  std::size_t memory_bytes = 0;
};

/// Where numbers come from; part of every row.
struct Provenance {
  std::string scene_hash, reference_hash, revision, machine;
};

struct ChartOptions {
  std::string label = "tact-lab chart";  // before the progress
  VariantRequest request;
  TimingSettings timing;
  const ground_truth::ToolReference* tool_reference = nullptr;  // laws are evaluated by it too
};

/// One row a variant. An error names what does not fit together, or says that Ctrl-C
/// ended it.
model::Result<std::vector<ChartRow>> measure_chart(const model::scene::Scene& scene,
                                                   const ground_truth::ReferenceData& reference,
                                                   const ChartOptions& options);

/// A row of the table "chart".
report::Row table_row(const ChartRow& row, const Provenance& provenance);
/// The rows on the front of tact's laws, fastest first. Times within 10 % are the
/// same time: of two such laws the nearer one stays.
std::vector<std::size_t> front_rows(const report::Table& table);
/// Peers that beat a law of the front in both, by however little; empty is what tact promises.
std::vector<std::size_t> peers_ahead(const report::Table& table);

}  // namespace tact::tools::chart
