// SPDX-License-Identifier: Apache-2.0
// tact-lab stability: where do the methods and the closed haptic loop stop being stable?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "model/io/json.h"
#include "tools/lab/commands.h"
#include "tools/stability/sweep/run_maps.h"

namespace tact::tools::lab {
namespace {

using nlohmann::json;
using namespace stability;

std::string help_of_maps() {
  std::string text = "Maps:\n";
  for (const auto& map : all_maps())
    text += fmt::format("  {}  {:16} {}\n", map.letter, map.name, map.purpose);
  return text + R"(
Each map becomes a table (CSV and JSON, SI units in the column names) and pictures (SVG and PNG by
gnuplot, with the script). A second run gives the same bytes.
Example: tact-lab stability --out maps --only loop --quick)";
}

struct Options {
  StabilityOptions maps;
  std::vector<std::string> letters{"a", "b", "c", "d"};
  bool quick = false, no_plots = false, json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("--out", o.maps.out, "folder for tables and pictures; made if need be")
      ->required();
  app.add_option("--map", o.letters, "which maps, by letter: a,b,c,d or fewer (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"a", "b", "c", "d"}));
  app.add_option("--only", o.maps.only, "one map by its name");
  app.add_flag("--quick", o.quick, "coarse grids, seconds instead of minutes");
  app.add_flag("--no-pictures", o.no_plots, "tables alone; needs no gnuplot");
  app.add_flag("--json", o.json, "print one JSON document");
}

void print_text(const std::vector<MapReport>& reports) {
  for (const MapReport& report : reports) {
    fmt::print("{}: {} rows\n", report.name, report.rows);
    for (const Finding& f : report.findings)
      fmt::print("  {}  {}\n", f.holds ? "ok  " : "FAIL", f.message);
    for (const std::string& file : report.files) fmt::print("  {}\n", file);
  }
}

json to_json(const std::vector<MapReport>& reports) {
  json maps = json::array();
  for (const MapReport& report : reports) {
    json findings = json::array();
    for (const Finding& f : report.findings)
      findings.push_back({{"holds", f.holds}, {"sentence", f.message}, {"numbers", f.numbers}});
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

model::Result<int> run(const program::Program& program, Options& o) {
  if (auto error = program::prepare_folder(o.maps.out)) return *error;
  for (const std::string& letter : o.letters) o.maps.letters += letter;
  o.maps.extent = o.quick ? Extent::kQuick : Extent::kFull;
  o.maps.draw_plots = !o.no_plots;
  const auto maps = run_maps(o.maps);
  // Maps that were finished are reported even if a later one failed.
  if (o.json)
    fmt::print("{}\n", model::io::text_of(to_json(maps.reports), 2));
  else
    print_text(maps.reports);
  if (maps.error)
    return program.fail(*maps.error, fmt::format("{} maps are written", maps.reports.size()));
  // 1: measured, and a message about it is false.
  return all_hold(maps.reports) ? 0 : 1;
}

}  // namespace

void add_stability(program::Program& lab) {
  lab.add<Options>(
      "stability", "where the methods and the closed haptic loop stop being stable",
      "Measured cell by cell against theory, and what the safety gate lets through beyond that.\n" +
          help_of_maps(),
      add_options, run);
}

}  // namespace tact::tools::lab
