// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/compare/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "model/scene/laws.h"
#include "tools/ground_truth/reference_fits.h"
#include "tools/program/run_program.h"

namespace tact::tools::chart {
namespace {

using model::Error;
using model::Result;
using model::scene::Scene;

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

std::string without_commas(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == '"' || c == '\n'; }, ';');
  return text;
}

/// Evaluated without relaxation and at small strain, as the reference is linear elastic; the memory
/// is that with the scene's relaxation.
ChartRow check_errors_of(const Scene& scene, const Scene& elastic, const Variant& variant,
                         const std::vector<ProbeCase>& cases, double pitch_m,
                         const ground_truth::ToolReference* tool_reference) {
  ChartRow row{.variant = variant};
  auto subject = make_subject(elastic, variant.sizes);
  if (subject) {
    const Accuracy accuracy = measure_accuracy(**subject, cases, pitch_m);
    row.errors = accuracy.errors;
    row.settle_ticks = accuracy.settle_ticks;
    if (!scene.relaxation.empty()) subject = make_subject(scene, variant.sizes);
  }
  if (!subject) {
    row.failure = subject.error().message;
    return row;
  }
  row.memory_bytes = (*subject)->memory_bytes();
  if (tool_reference == nullptr) return row;
  const auto checked = check_errors(sized(scene, variant.sizes), *tool_reference);
  row.failure = checked ? checked->failure : checked.error().message;
  if (row.failure.empty()) row.tool = checked->errors;
  return row;
}

std::vector<SpeedAndError> points_of(const report::Table& table,
                                     const std::vector<std::size_t>& rows) {
  std::vector<SpeedAndError> out;
  out.reserve(rows.size());
  for (const std::size_t i : rows)
    out.push_back({.tick_us = number(table.rows()[i], "tick_median_us"),
                   .error_ratio = number(table.rows()[i], "force_rms_ratio")});
  return out;
}

std::vector<std::size_t> rows_of(const report::Table& table, const std::string& kind) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < table.rows().size(); ++i)
    if (word(table.rows()[i], "kind") == kind) out.push_back(i);
  return out;
}

}  // namespace

Result<std::vector<ChartRow>> measure_chart(const Scene& scene,
                                            const ground_truth::ReferenceData& reference,
                                            const ChartOptions& options) {
  const auto cases = cases_of(scene, reference);
  if (!cases) return cases.error();
  const std::vector<Variant> variants = variants_of(scene, options.request);
  if (options.tool_reference != nullptr)
    if (auto differs = check_tool_reference_fits(*options.tool_reference, scene))
      return std::move(*differs);
  if (variants.empty())
    return Error{
        fmt::format("{}: none of the wanted laws is described; write its section or "
                    "leave out --laws",
                    scene.path)};
  Scene elastic = scene;
  elastic.relaxation.clear();
  elastic.compliance.large_strain = false;
  std::vector<ChartRow> all(variants.size());
  const program::SweepOptions sweep_options{.label = options.label + ", accuracy"};
  const bool checked = run_jobs(variants.size(), sweep_options, [&](std::size_t job) {
    all[job] = check_errors_of(scene, elastic, variants[job], *cases, reference.ring_pitch_m,
                               options.tool_reference);
  });
  if (!checked) return program::interruption();
  // One after the other: a second one on another core would share cache and memory with the first.
  const program::SweepOptions one_by_one{.label = options.label + ", time", .threads = 1};
  const bool timed = run_jobs(variants.size(), one_by_one, [&](std::size_t job) {
    if (!all[job].failure.empty()) return;
    if (const auto timing = time_tool(sized(scene, variants[job].sizes), options.timing))
      all[job].timing = *timing;
    else
      all[job].failure = timing.error().message;
  });
  if (!timed) return program::interruption();
  return all;
}

// NOLINTNEXTLINE(readability-function-size): a table of columns
report::Row table_row(const ChartRow& row, const Provenance& provenance) {
  const model::scene::LawSizes& sizes = row.variant.sizes;
  // A row that failed has NaN: a zero would look like the best of all.
  const auto measured = [&](auto value) {
    return row.failure.empty() ? static_cast<double>(value) : kNotMeasured;
  };
  const ErrorSummary& e = row.errors;
  const auto or_dash = [](const std::string& text) {
    return text.empty() ? "-" : without_commas(text);
  };
  return {{"kind", "tact"},
          {"family", sizes.law},
          {"size", row.variant.size()},
          {"form", or_dash(sizes.disc_form)},
          {"table_knots", sizes.table_knots},
          {"size_count", sizes.size},
          {"force_rms_ratio", measured(e.force_rms_ratio)},
          {"force_worst_ratio", measured(e.force_worst_ratio)},
          {"press_rms_ratio", measured(e.press_rms_ratio)},
          {"pull_rms_ratio", measured(e.pull_rms_ratio)},
          {"held_out_rms_ratio", measured(e.held_out_rms_ratio)},
          {"worst_site_rms_ratio", measured(e.worst_site_rms_ratio)},
          {"own_worst_1mm_ratio", measured(e.own_worst_ratio[0])},
          {"own_worst_2mm_ratio", measured(e.own_worst_ratio[1])},
          {"own_worst_5mm_ratio", measured(e.own_worst_ratio[2])},
          {"own_worst_10mm_ratio", measured(e.own_worst_ratio[3])},
          {"own_worst_ratio", measured(e.own_largest_ratio)},
          {"within_jnd_ratio", measured(e.within_jnd_ratio)},
          {"tool_rms_ratio", measured(row.tool ? row.tool->rms_ratio : kNotMeasured)},
          {"tool_own_worst_ratio", measured(row.tool ? row.tool->own_largest_ratio : kNotMeasured)},
          {"shape_rms_ratio", measured(e.shape_rms_ratio)},
          {"shape_worst_ratio", measured(e.shape_worst_ratio)},
          {"cases", measured(e.cases)},
          {"settle_ticks", measured(row.settle_ticks)},
          {"memory_bytes", measured(row.memory_bytes)},
          {"given", "parameters of the scene"},
          {"failure", or_dash(row.failure)},
          {"scene_hash", provenance.scene_hash},
          {"reference_hash", provenance.reference_hash},
          {"revision", or_dash(provenance.revision)},
          {"machine", or_dash(provenance.machine)},
          {"tick_median_us", measured(row.timing.median_us)},
          {"tick_p999_us", measured(row.timing.p999_us)},
          {"instructions", measured(row.timing.instructions)},
          {"ticks", measured(row.timing.ticks)},
          {"paused", measured(row.timing.paused)}};
}

std::vector<std::size_t> front_rows(const report::Table& table) {
  const auto rows = rows_of(table, "tact");
  const auto points = points_of(table, rows);
  const auto front = front_of(points);
  std::vector<std::size_t> out;  // from the slow end: each against the last that stayed
  double kept_us = std::numeric_limits<double>::infinity();
  for (auto k = front.rbegin(); k != front.rend(); ++k) {
    if ((1.0 + kSameTime_ratio) * points[*k].tick_us >= kept_us) continue;
    kept_us = points[*k].tick_us;
    out.insert(out.begin(), rows[*k]);
  }
  return out;
}

std::vector<std::size_t> peers_ahead(const report::Table& table) {
  const auto laws = points_of(table, rows_of(table, "tact"));
  const auto front = front_of(laws);
  const auto peers = rows_of(table, "peer");
  const auto points = points_of(table, peers);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const bool faster_and_better = std::any_of(front.begin(), front.end(), [&](std::size_t k) {
      // Without kSameTime_ratio: the promise has no allowance.
      return points[i].tick_us < laws[k].tick_us && points[i].error_ratio < laws[k].error_ratio;
    });
    if (faster_and_better) out.push_back(peers[i]);
  }
  return out;
}

}  // namespace tact::tools::chart
