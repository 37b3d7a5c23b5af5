// SPDX-License-Identifier: Apache-2.0
// figures.h - the figures of the documents behind tact, drawn again with its laws.
//
// No copy holds a curve. Where a document prints numbers to a figure, they stand beside ours;
// elsewhere the curves are ours alone, and the figure says so. Documents: [1] to [4] of
// model/SOURCES.md.
#pragma once

#include <string>
#include <vector>

#include "tools/report/plot.h"
#include "tools/report/table.h"

namespace tact::tools::figures {

/// A number that a document prints, and what tact has for it.
struct Printed {
  std::string quantity;  // with its unit
  double printed = 0.0;
  double ours = 0.0;
};

struct Figure {
  std::string of;  // "[2] fig. 3"
  std::string shows;
  report::Plot plot;
  report::Table curves;               // what the picture plots, of its name
  std::vector<Printed> numbers = {};  // none: its document prints none
};

std::vector<Figure> all_figures();
/// One row for each printed number of all figures.
report::Table numbers_of(const std::vector<Figure>& figures);

// The curves of each figure, and what its document prints.
using Rows = std::vector<report::Row>;
Rows rhombus_units();
Rows disc_layers();
std::vector<Printed> disc_example();
Rows skin_rings();
Rows near_field_indentation();
Rows skin_press();
Rows euler_methods();
Rows alpha_search();
std::vector<Printed> best_alpha();
Rows alpha_curves();
Rows step_methods();
Rows step_sizes();

}  // namespace tact::tools::figures
