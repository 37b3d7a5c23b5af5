// SPDX-License-Identifier: Apache-2.0
// tact-lab stability: where do the methods and the closed haptic loop stop being stable? The tables
// are made here; evaluated, reported and drawn by stability/stability.py.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/lab/commands.h"
#include "tools/lab/script.h"
#include "tools/program/run_program.h"
#include "tools/stability/sweep/run_maps.h"

namespace tact::tools::lab {
namespace {

using model::Result;
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

Result<int> run(const program::Program&, Options& o) {
  if (auto error = program::prepare_folder(o.maps.out)) return *error;
  for (const std::string& letter : o.letters) o.maps.letters += letter;
  o.maps.extent = o.quick ? Extent::kQuick : Extent::kFull;
  auto done = run_maps(o.maps);
  // Maps that were finished are reported even if a later one failed.
  return become("stability/stability.py",
                {{"out", o.maps.out},
                 {"json", o.json},
                 {"draw", !o.no_plots},
                 {"maps", std::move(done.maps)},
                 {"failure", done.error ? done.error->message : ""},
                 {"interrupted", done.error && program::was_interrupted(*done.error)}},
                AfterCtrlC::kToo);
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
