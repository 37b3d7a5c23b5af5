// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/sweep/run_maps.h"

#include <fmt/format.h>

#include "tools/program/run_program.h"
#include "tools/program/sweep.h"

namespace tact::tools::stability {
namespace {

using model::Error;
using model::Result;

Result<report::Table> computed(const Map& map, const StabilityOptions& options) {
  // In the order of the jobs, not of their end: a second run gives the same bytes.
  auto rows =
      program::sweep<report::Row>(map.jobs(options.extent), {.label = map.name},
                                  [&](std::size_t job) { return map.run(job, options.extent); });
  if (!rows) return program::interruption();
  return report::Table(map.name, std::move(*rows));
}

/// Table, verdict and picture of a map.
Result<MapReport> finished(const Map& map, const report::Table& table,
                           const StabilityOptions& options) {
  MapReport report{.name = map.name, .rows = table.rows().size(), .findings = {}, .files = {}};
  // Before it is evaluated and drawn: the work stays even if gnuplot is missing.
  auto files = table.write(options.out);
  if (!files) return files.error();
  report.files = std::move(*files);
  report.findings = map.check(table);
  if (!options.draw_plots || map.plot.script.empty()) return report;
  report::Plot plot = map.plot;
  plot.name = map.name;
  if (map.variables != nullptr) plot.variables = map.variables(options.extent);
  const auto drawn = draw(plot, options.out);
  if (!drawn) return drawn.error();
  report.files.insert(report.files.end(), drawn->begin(), drawn->end());
  return report;
}

bool is_chosen(const Map& map, const StabilityOptions& options) {
  // --only wins over --map.
  if (!options.only.empty()) return options.only == map.name;
  return options.letters.find(map.letter) != std::string::npos;
}

}  // namespace

std::vector<Map> all_maps() {
  return {integrator_map(), law_limit_map(),  law_line_map(), loop_map(),
          law_loop_map(),   delta_loop_map(), tick_map(),     loss_map()};
}

MapsRun run_maps(const StabilityOptions& options) {
  MapsRun run;
  bool any = false;
  for (const Map& map : all_maps()) {
    if (!is_chosen(map, options)) continue;
    any = true;
    const auto table = computed(map, options);
    if (!table) return {std::move(run.reports), table.error()};
    auto report = finished(map, *table, options);
    if (!report) return {std::move(run.reports), report.error()};
    run.reports.push_back(std::move(*report));
  }
  if (!any) run.error = Error{"no map chosen; --help lists their names"};
  return run;
}

}  // namespace tact::tools::stability
