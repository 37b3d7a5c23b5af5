// SPDX-License-Identifier: Apache-2.0
// chart.h - what every law and size of a scene answers, and its time: numbers for chart.py, which
// compares them with the reference.
//
// First all rows are made and pressed on all cores, then timed one after the other, so that they
// do not disturb each other. Forces are the same on every machine; times belong to the machine.
// The time of a law is the tick that a user gets: detect, render and limit of the scene's whole
// tool (tool_check.h).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/scene/plan_file.h"
#include "tools/chart/compare/tool_check.h"
#include "tools/chart/measure/measure.h"
#include "tools/program/sweep.h"

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

/// A law and size, or a law as the scene has it.
struct Measured {
  Variant variant{};
  std::string failure{};                      // empty: it was measured
  Answers answers{};                          // of one sphere
  std::optional<std::vector<double>> tool{};  // forces of the whole tool; none: no reference
  Timing timing{};
  std::size_t memory_bytes = 0;
};
nlohmann::json to_json(const Measured& measured);
/// The places of a reference and their depths, in the order of press_tool().
nlohmann::json to_json(const ground_truth::ToolReference& reference);

struct ChartOptions {
  std::string label = "tact-lab chart";  // before the progress
  VariantRequest request;
  TimingSettings timing;
  std::optional<ground_truth::ToolReference> tool_reference{};  // laws are evaluated by it, too
};

/// What is true under the whole tool, by two files of tact-lab reference --tool: into `options` and
/// job["places"]. Places that `finite_strain` contradicts are dropped: into job["dropped"]. Empty
/// paths: none.
std::optional<model::Error> add_tool_reference(nlohmann::json& job, ChartOptions& options,
                                               const model::scene::Scene& scene,
                                               const std::string& path,
                                               const std::string& finite_strain);

/// Every variant. An error names what does not fit together, or says that Ctrl-C ended it.
model::Result<std::vector<Measured>> measure_chart(const model::scene::Scene& scene,
                                                   const ground_truth::ReferenceData& reference,
                                                   const ChartOptions& options);
/// The laws that are wanted, as the scene has them, with its whole tool.
model::Result<std::vector<Measured>> measure_tool(const model::scene::Scene& scene,
                                                  const ChartOptions& options);

/// Version of chart.json; read_chart() takes this one alone, as an older chart has other columns.
inline constexpr int kChartVersion = 4;
/// The rows of a chart.json. What they lack, chart.py reports.
model::Result<nlohmann::json> read_chart(const std::string& path);
/// The rows of kind "peer" of another chart.json; none without a path. An error: they were measured
/// against another reference.
model::Result<nlohmann::json> peers_of(const std::string& path, const std::string& reference_hash);

}  // namespace tact::tools::chart
