// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/sweep/run_maps.h"

#include "tools/program/run_program.h"
#include "tools/program/sweep.h"

namespace tact::tools::stability {
namespace {

using model::Error;
using model::Result;
using nlohmann::json;

Result<report::Table> computed(const Map& map, const StabilityOptions& options) {
  // In the order of the jobs, not of their end: a second run gives the same bytes.
  auto rows =
      program::sweep<report::Row>(map.jobs(options.extent), {.label = map.name},
                                  [&](std::size_t job) { return map.run(job, options.extent); });
  if (!rows) return program::interruption();
  return report::Table(map.name, std::move(*rows));
}

/// The table on disk, with what the report needs of it.
Result<json> written(const Map& map, const report::Table& table, const std::string& directory) {
  const auto files = table.write(directory);
  if (!files) return files.error();
  json rows = json::array();
  for (const report::Row& row : table.rows()) {
    json& cells = rows.emplace_back();
    for (const auto& [column, cell] : row)
      std::visit([&](const auto& value) { cells[column] = value; }, cell);
  }
  return json{{"map", map.name},
              {"rows", std::move(rows)},
              {"files", *files},
              {"facts", map.facts != nullptr ? map.facts() : json::object()}};
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
    auto done = table ? written(map, *table, options.out) : table.error();
    if (!done) {
      run.error = done.error();
      return run;
    }
    run.maps.push_back(std::move(*done));
  }
  if (!any) run.error = Error{"no map chosen; --help lists their names"};
  return run;
}

}  // namespace tact::tools::stability
