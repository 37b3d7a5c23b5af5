// SPDX-License-Identifier: Apache-2.0
// tact-lab figures: the figures of the documents behind tact, drawn again.
#include "tools/figures/figures.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/lab/commands.h"

namespace tact::tools::lab {
namespace {

struct Options {
  std::string out;
  bool no_plots = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("--out", o.out, "folder for tables and pictures; made if need be")->required();
  app.add_flag("--no-pictures", o.no_plots, "tables only, without gnuplot");
}

model::Result<int> run(const program::Program& program, Options& o) {
  if (auto error = program::prepare_folder(o.out)) return *error;
  const auto all = figures::all_figures();
  const auto numbers = figures::numbers_of(all);
  if (const auto files = numbers.write(o.out); !files) return files.error();
  for (const figures::Figure& figure : all) {
    const std::string kept = "the figures before " + figure.of + " are written";
    if (const auto files = figure.curves.write(o.out); !files)
      return program.fail(files.error(), kept);
    if (o.no_plots) continue;
    if (const auto files = report::draw(figure.plot, o.out); !files)
      return program.fail(files.error(), kept);
  }
  for (const figures::Figure& figure : all)
    fmt::print("{:16} {:18} {}{}\n", figure.plot.name, figure.of, figure.shows,
               figure.numbers.empty() ? "; no printed number: tact's alone" : "");
  fmt::print("\n{:18} {:28} {:>10} {:>10} {:>9}\n", "figure", "quantity", "printed", "tact",
             "differs");
  for (const auto& row : numbers.rows())
    fmt::print("{:18} {:28} {:>10.6g} {:>10.6g} {:>7.2f} %\n", word(row, "figure"),
               word(row, "quantity"), number(row, "printed"), number(row, "tact"),
               number(row, "difference_percent"));
  return 0;
}

}  // namespace

void add_figures(program::Program& lab) {
  lab.add<Options>(
      "figures", "the figures of the documents behind tact, drawn again, and their numbers",
      R"(Each figure becomes a table (CSV and JSON, units in the column names) and a picture (SVG
and PNG by gnuplot, with the script). numbers.csv: what the documents print, what tact
has, the difference in percent of the printed number. [1] to [4]: model/SOURCES.md.
Example: tact-lab figures --out figures)",
      add_options, run);
}

}  // namespace tact::tools::lab
