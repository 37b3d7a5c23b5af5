// SPDX-License-Identifier: Apache-2.0
// tact-figures: the figures of the documents behind tact, drawn anew.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/figures/figures.h"
#include "tools/program/program.h"

int main(int argc, char** argv) {
  using tact::tools::figures::Figure;
  tact::tools::program::Program program(
      "tact-figures",
      "The figures of the documents behind tact, drawn anew with its laws, and the numbers that "
      "they print\nbeside tact's.",
      "Each figure becomes a table (CSV and JSON, units in the column names) and a picture (SVG "
      "and "
      "PNG by\ngnuplot, with the script). numbers.csv: what the documents print, what tact has, "
      "the difference in\npercent of the printed number. [1] to [4]: model/SOURCES.md.");
  std::string out;
  bool no_pictures = false;
  program.options()
      .add_option("--out", out, "folder for tables and pictures; made if need be")
      ->required();
  program.options().add_flag("--no-pictures", no_pictures, "tables only, without gnuplot");
  if (const auto status = program.parse(argc, argv)) return *status;
  if (const auto error = tact::tools::program::prepare_folder(out)) return program.fail(*error);

  const auto figures = tact::tools::figures::all_figures();
  const auto numbers = tact::tools::figures::numbers_of(figures);
  if (const auto files = numbers.write(out); !files) return program.fail(files.error());
  for (const Figure& figure : figures) {
    const std::string kept = "the figures before " + figure.of + " are written";
    if (const auto files = figure.curves.write(out); !files)
      return program.fail(files.error(), kept);
    if (no_pictures) continue;
    if (const auto files = tact::tools::report::draw(figure.picture, out); !files)
      return program.fail(files.error(), kept);
  }
  for (const Figure& figure : figures)
    fmt::print("{:16} {:18} {}{}\n", figure.name, figure.of, figure.shows,
               figure.numbers.empty() ? "; no printed number: tact's alone" : "");
  fmt::print("\n{:18} {:28} {:>10} {:>10} {:>9}\n", "figure", "quantity", "printed", "tact",
             "differs");
  for (const auto& row : numbers.rows())
    fmt::print("{:18} {:28} {:>10.6g} {:>10.6g} {:>7.2f} %\n", numbers.word(row, "figure"),
               numbers.word(row, "quantity"), numbers.number(row, "printed"),
               numbers.number(row, "tact"), numbers.number(row, "difference_percent"));
  return 0;
}
