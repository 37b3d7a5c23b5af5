// SPDX-License-Identifier: Apache-2.0
// tact-stability: where do the methods and the closed haptic loop stop being stable?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "model/io/json.h"
#include "tools/program/program.h"
#include "tools/stability/sweep/run_maps.h"

namespace {

using nlohmann::json;
using tact::tools::stability::Finding;
using tact::tools::stability::MapReport;
using tact::tools::stability::StabilityOptions;

std::string help_of_maps() {
  std::string text = "Maps:\n";
  for (const auto& map : tact::tools::stability::all_maps())
    text += fmt::format("  {}  {:16} {}\n", map.letter, map.name, map.purpose);
  return text +
         "\nEach map becomes a table (CSV and JSON, SI units in the column names) and pictures "
         "(SVG "
         "and\nPNG by gnuplot, with the script). A second run gives the same bytes. Over several "
         "machines: run\n--shard 0/4 to 3/4, then --merge *.shard-*.csv with the same --quick.";
}

void print_text(const std::vector<MapReport>& reports) {
  for (const MapReport& report : reports) {
    fmt::print("{}: {} rows\n", report.name, report.rows);
    for (const Finding& f : report.findings)
      fmt::print("  {}  {}\n", f.holds ? "ok  " : "FAIL", f.sentence);
    for (const std::string& file : report.files) fmt::print("  {}\n", file);
  }
}

json to_json(const std::vector<MapReport>& reports) {
  json maps = json::array();
  for (const MapReport& report : reports) {
    json findings = json::array();
    for (const Finding& f : report.findings)
      findings.push_back({{"holds", f.holds}, {"sentence", f.sentence}, {"numbers", f.numbers}});
    maps.push_back({{"map", report.name},
                    {"rows", report.rows},
                    {"findings", findings},
                    {"files", report.files}});
  }
  return {{"format", "tact-stability"}, {"version", 1}, {"maps", maps}};
}

bool all_hold(const std::vector<MapReport>& reports) {
  return std::all_of(reports.begin(), reports.end(), [](const MapReport& report) {
    return std::all_of(report.findings.begin(), report.findings.end(),
                       [](const Finding& f) { return f.holds; });
  });
}

}  // namespace

int main(int argc, char** argv) {
  tact::tools::program::Program program(
      "tact-stability",
      "Where do the methods and the closed haptic loop stop being stable? Measured cell by cell, "
      "against\ntheory, and what the safety gate lets through beyond the line.",
      help_of_maps());
  StabilityOptions options;
  tact::tools::program::SweepArguments sweep;
  std::vector<std::string> letters{"a", "b", "c", "d"};
  bool as_json = false;
  CLI::App& app = program.options();
  app.add_option("--out", options.out, "folder for tables and pictures; made if need be")
      ->required();
  app.add_option("--map", letters, "which maps, by letter: a,b,c,d or fewer (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"a", "b", "c", "d"}));
  app.add_option("--only", options.only, "one map by its name");
  sweep.add_to(app, "cell", "coarse grids, seconds instead of minutes");
  app.add_flag("--json", as_json, "print one JSON document");
  if (const auto status = program.parse(argc, argv)) return *status;
  if (const auto error = sweep.prepare(options.out)) return program.fail(*error);
  options.shard = sweep.shard;
  options.merge = sweep.merge;
  for (const std::string& letter : letters) options.letters += letter;
  options.grid =
      sweep.quick ? tact::tools::stability::Grid::kQuick : tact::tools::stability::Grid::kFull;
  options.draw_pictures = !sweep.no_pictures;
  const auto run = tact::tools::stability::run_maps(options);
  // Maps that were finished are told even if a later one failed.
  if (as_json)
    fmt::print("{}\n", tact::model::io::text_of(to_json(run.reports), 2));
  else
    print_text(run.reports);
  if (run.error)
    return program.fail(*run.error, fmt::format("{} maps are written", run.reports.size()));
  // 1: measured, and a sentence about it is false.
  return all_hold(run.reports) ? 0 : 1;
}
