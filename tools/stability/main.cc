// tact-stability: where do the methods and the closed haptic loop stop being stable?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/common/interrupt.h"
#include "tools/stability/run_maps.h"

namespace {

using nlohmann::json;
using tact::tools::Finding;
using tact::tools::MapReport;
using tact::tools::StabilityOptions;

std::string help_of_maps() {
  std::string text = "Maps:\n";
  for (const auto& map : tact::tools::all_maps())
    text += fmt::format("  {}  {:16} {}\n", map.letter, map.name, map.purpose);
  return text +
         "\nEach map becomes a table (CSV and JSON, SI units in the column names) and pictures "
         "(SVG "
         "and\nPNG by gnuplot, with the script). A second run gives the same bytes. Over several "
         "machines: run\n--shard 0/4 to 3/4, then --merge *.shard-*.csv with the same --quick.\n"
         "Exit status: 0 every finding holds, 1 one does not or Ctrl-C, 2 bad usage or input.";
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
      findings.push_back({{"holds", f.holds}, {"sentence", f.sentence}});
    maps.push_back({{"map", report.name},
                    {"rows", report.rows},
                    {"findings", findings},
                    {"files", report.files}});
  }
  return {{"maps", maps}};
}

bool all_hold(const std::vector<MapReport>& reports) {
  return std::all_of(reports.begin(), reports.end(), [](const MapReport& report) {
    return std::all_of(report.findings.begin(), report.findings.end(),
                       [](const Finding& f) { return f.holds; });
  });
}

int complain(const std::string& sentence, int status) {
  fmt::print(stderr, "tact-stability: {}\n", sentence);
  return status;
}

}  // namespace

// The libraries throw when memory or standard output is gone; then the program may as well end.
int main(int argc, char** argv) {
  CLI::App app{
      "Where do the methods and the closed haptic loop stop being stable? Measured cell by cell, "
      "against\ntheory, and what the safety gate lets through beyond the line."};
  StabilityOptions options;
  std::vector<std::string> letters{"a", "b", "c", "d"};
  std::string shard_text;
  bool quick = false, as_json = false, no_pictures = false;
  app.add_option("--out", options.out, "folder for tables and pictures; made if need be")
      ->required();
  app.add_option("--map", letters, "which maps, by letter: a,b,c,d or fewer (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"a", "b", "c", "d"}));
  app.add_option("--only", options.only, "one map by its name");
  app.add_option("--shard", shard_text, "i/n: every n-th cell from i on, 0 <= i < n");
  app.add_option("--merge", options.merge, "CSVs of all shards: the table of one whole run");
  app.add_flag("--quick", quick, "coarse grids, seconds instead of minutes");
  app.add_flag("--no-pictures", no_pictures, "tables alone; needs no gnuplot");
  app.add_flag("--json", as_json, "print one JSON document");
  app.footer(help_of_maps());
  app.failure_message([](const CLI::App*, const CLI::Error& e) {
    return fmt::format("tact-stability: {}; see tact-stability --help\n", e.what());
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  if (!shard_text.empty()) {
    const auto shard = tact::tools::parse_shard(shard_text);
    if (!shard) return complain(shard.error().sentence, 2);
    options.shard = *shard;
  }
  for (const std::string& letter : letters) options.letters += letter;
  options.grid = quick ? tact::tools::Grid::kQuick : tact::tools::Grid::kFull;
  options.draw_pictures = !no_pictures;
  const auto reports = tact::tools::run_maps(options);
  if (!reports) return complain(reports.error().sentence, tact::tools::is_interrupted() ? 1 : 2);
  if (reports->empty()) return complain("no map chosen; --help lists their names", 2);
  if (as_json) {
    fmt::print("{}\n", to_json(*reports).dump(2));
  } else {
    print_text(*reports);
  }
  return all_hold(*reports) ? 0 : 1;
}
