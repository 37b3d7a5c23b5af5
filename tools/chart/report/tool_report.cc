// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/report/tool_report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "model/io/json.h"

namespace tact::tools::chart {
namespace {

using ground_truth::ToolReference;
using nlohmann::ordered_json;

std::string mm_text(double depth_m) { return fmt::format("{:g}", depth_m * 1e3); }

ordered_json summary_of(const ToolRow& row, const ToolReference& reference) {
  ordered_json out{{"law", row.law}};
  if (!row.failure.empty()) {
    out["failure"] = row.failure;
    return out;
  }
  out["force_rms_ratio"] = row.errors.rms_ratio;
  out["force_worst_ratio"] = row.errors.worst_ratio;
  // NaN where the reference has no unseen place; null in the text.
  out["unseen_rms_ratio"] = row.errors.unseen_rms_ratio;
  out["within_jnd_ratio"] = row.errors.within_jnd_ratio;
  for (std::size_t k = 0; k < row.errors.own_worst_ratio.size(); ++k)
    out["own_worst_ratio_at_mm"][mm_text(reference.places.front().cases[k].depth_m)] =
        row.errors.own_worst_ratio[k];
  for (std::size_t i = 0; i < reference.places.size(); ++i)
    out["place_rms_ratio"][name_of(reference.places[i])] = row.errors.place_rms_ratio[i];
  out["tick_median_us"] = row.timing.median_us;
  out["tick_p999_us"] = row.timing.p999_us;
  out["instructions"] = row.timing.instructions;
  return out;
}

}  // namespace

report::Table tool_table(const std::vector<ToolRow>& rows, const ToolReference& reference) {
  report::Table table("tool");
  for (const ToolRow& row : rows)
    for (const ToolSample& s : row.samples) {
      const auto& place = reference.places[s.place];
      table.add({{"law", row.law},
                 {"place", name_of(place)},
                 {"depth_m", place.cases[s.depth].depth_m},
                 {"force_N", s.force_N},
                 {"reference_N", s.reference_N},
                 {"own_error_ratio", s.own_ratio()},
                 {"reference_error_ratio", place.cases[s.depth].force_error_ratio}});
    }
  return table;
}

std::string tool_json(const std::vector<ToolRow>& rows, const ToolReference& reference,
                      const std::string& command, const Provenance& provenance) {
  ordered_json document{{"format", "tact-tool-chart"},
                        {"version", 2},
                        {"command", command},
                        {"scene", provenance.scene_hash},
                        {"reference", provenance.reference_hash},
                        {"revision", provenance.revision},
                        {"machine", provenance.machine}};
  for (const ToolRow& row : rows) document["laws"].push_back(summary_of(row, reference));
  const auto table =
      model::io::parse_json<ordered_json>(tool_table(rows, reference).to_json(), "tool");
  document["rows"] = table->at("rows");
  return model::io::text_of(document, 1) + "\n";
}

std::string tool_text(const std::vector<ToolRow>& rows, const ToolReference& reference) {
  const auto& depths = reference.places.front().cases;
  std::string out = fmt::format("{:<14} {:>8} {:>8} {:>9}", "law", "RMS %", "worst %", "unseen %");
  for (const auto& c : depths) out += fmt::format(" {:>8}", mm_text(c.depth_m) + " mm");
  out += fmt::format(" {:>10} {:>9} {:>8}\n", "median us", "p99.9 us", "instr.");
  const auto percent = [](double ratio) { return fmt::format(" {:>+8.1f}", 100.0 * ratio); };
  for (const ToolRow& row : rows) {
    out += fmt::format("{:<14}", row.law);
    if (!row.failure.empty()) {
      out += fmt::format(" not measured: {}\n", row.failure);
      continue;
    }
    const ToolErrors& e = row.errors;
    out += fmt::format(" {:>8.2f} {:>8.2f} {:>9.2f}", 100.0 * e.rms_ratio, 100.0 * e.worst_ratio,
                       100.0 * e.unseen_rms_ratio);
    for (const double own : e.own_worst_ratio) out += percent(own);
    const double instructions = row.timing.instructions;
    out += fmt::format(" {:>10.3f} {:>9.3f} {:>8}\n", row.timing.median_us, row.timing.p999_us,
                       std::isfinite(instructions) ? fmt::format("{:.0f}", instructions) : "n/a");
    std::size_t place = reference.places.size();
    for (const ToolSample& s : row.samples) {
      if (s.place != place) {
        place = s.place;
        out +=
            fmt::format("{}  {:<12} {:>8.2f} {:>8} {:>9}", s.depth + s.place > 0 ? "\n" : "",
                        name_of(reference.places[place]), 100.0 * e.place_rms_ratio[place], "", "");
      }
      out += percent(s.own_ratio());
    }
    out += "\n";
  }
  return out +
         "RMS and worst: % of the largest force of the reference, at a place % of its own "
         "largest.\n1 mm and so on: % of the own force there, for a law the worst place's. Time: "
         "detect, render, limit.\n";
}

model::Result<std::vector<model::scene::Accuracy>> accuracy_of(
    const model::scene::Scene& scene, const std::vector<ToolRow>& rows,
    const ground_truth::ToolReference& reference) {
  std::vector<model::scene::Accuracy> out;
  for (const ToolRow& row : rows) {
    // A law that could not be made has no accuracy to report.
    if (!row.failure.empty()) continue;
    const auto law = model::scene::make_tissue_law(scene, row.law);
    if (!law) return law.error();
    const auto hash = model::scene::hash_of_linear_forces(scene, row.law);
    if (!hash) return hash.error();
    model::scene::Accuracy a{
        .law = row.law,
        // By its forces, not by the file: tactd knows the law again also if other parts of the
        // scene change.
        .law_hash = *hash,
        .reference = fmt::format("linear finite elements at {} places", reference.places.size()),
        .date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))),
        .large_strain_off = scene.compliance.large_strain &&
                            ((*law)->organ() != nullptr || row.law == "compliance"),
        .rms_ratio = row.errors.rms_ratio,
        .within_noticeable_ratio = row.errors.within_jnd_ratio,
        .depth_m = {},
        .own_worst_ratio = row.errors.own_worst_ratio};
    for (const ground_truth::ToolCase& c : reference.places.front().cases)
      a.depth_m.push_back(c.depth_m);
    out.push_back(std::move(a));
  }
  return out;
}

}  // namespace tact::tools::chart
