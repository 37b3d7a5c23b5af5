// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/sweep/run_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "tools/program/run_program.h"

namespace tact::tools::stability {
namespace {

using model::Error;
using model::Result;

report::Table empty_table(const Map& map, const StabilityOptions& options,
                          const program::Shard& shard) {
  return {map.name, map.columns(), map.jobs(options.grid), shard};
}

Result<report::Table> computed(const Map& map, const StabilityOptions& options) {
  report::Table table = empty_table(map, options, options.shard);
  // In the order of the jobs, whoever was first: a second run gives the same bytes.
  const auto rows =
      program::sweep<report::Row>(table.jobs(), {.label = map.name, .shard = options.shard},
                                  [&](std::size_t job) { return map.run(job, options.grid); });
  if (!rows) return program::interruption();
  for (const report::Row& row : *rows) table.add(row);
  return table;
}

/// Table, verdict and pictures of a whole map; of a shard the table alone.
Result<MapReport> finished(const Map& map, const report::Table& table,
                           const StabilityOptions& options, bool is_whole) {
  MapReport report{.name = map.name, .rows = table.rows().size(), .findings = {}, .files = {}};
  // Before it is judged and drawn: the work stays even if gnuplot is missing.
  auto files = table.write(options.out);
  if (!files) return files.error();
  report.files = std::move(*files);
  if (!is_whole) return report;
  report.findings = map.judge(table);
  if (!options.draw_pictures || map.pictures == nullptr) return report;
  for (const report::Picture& picture : map.pictures(options.grid)) {
    const auto drawn = draw(picture, options.out);
    if (!drawn) return drawn.error();
    report.files.insert(report.files.end(), drawn->begin(), drawn->end());
  }
  return report;
}

/// The given CSVs by the table that they are a part of.
Result<std::map<std::string, std::vector<std::string>>> sorted(
    const std::vector<std::string>& files) {
  std::map<std::string, std::vector<std::string>> of_table;
  for (const std::string& path : files) {
    const auto name = report::table_of_file(path);
    if (!name) return name.error();
    of_table[*name].push_back(path);
  }
  return of_table;
}

bool is_chosen(const Map& map, const StabilityOptions& options) {
  // --only wins over --map.
  if (!options.only.empty()) return options.only == map.name;
  return options.letters.find(map.letter) != std::string::npos;
}

MapsRun merged(const StabilityOptions& options) {
  const auto of_table = sorted(options.merge);
  if (!of_table) return {{}, of_table.error()};
  MapsRun run;
  const std::vector<Map> maps = all_maps();
  for (const auto& [name, files] : *of_table)
    if (std::ranges::find(maps, name, &Map::name) == maps.end())
      return {{},
              Error{fmt::format("{}: \"{}\" is no map of tact-stability", files.front(), name)}};
  for (const Map& map : maps) {
    const auto files = of_table->find(map.name);
    if (files == of_table->end()) continue;
    // Refuses shards that are missing, given twice or run with other options.
    const auto table = merge_table(empty_table(map, options, {}), files->second);
    if (!table) return {std::move(run.reports), table.error()};
    auto report = finished(map, *table, options, true);
    if (!report) return {std::move(run.reports), report.error()};
    run.reports.push_back(std::move(*report));
  }
  return run;
}

}  // namespace

MapsRun run_maps(const StabilityOptions& options) {
  if (!options.merge.empty()) return merged(options);
  MapsRun run;
  bool any = false;
  for (const Map& map : all_maps()) {
    if (!is_chosen(map, options)) continue;
    any = true;
    const auto table = computed(map, options);
    if (!table) return {std::move(run.reports), table.error()};
    auto report = finished(map, *table, options, options.shard.is_whole());
    if (!report) return {std::move(run.reports), report.error()};
    run.reports.push_back(std::move(*report));
  }
  if (!any) run.error = Error{"no map chosen; --help lists their names"};
  return run;
}

}  // namespace tact::tools::stability
