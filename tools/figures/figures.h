// SPDX-License-Identifier: Apache-2.0
// figures.h - the figures of the documents behind tact, drawn again with its laws.
//
// No copy holds a curve. Where a document prints numbers to a figure, they stand beside ours;
// elsewhere the curves are ours alone, and the figure says so. Documents: [1] to [4] of
// model/SOURCES.md.
#pragma once

#include <string>
#include <vector>

#include "tools/report/picture.h"
#include "tools/report/table.h"

namespace tact::tools::figures {

/// A number that a document prints, and what tact has for it.
struct Printed {
  std::string quantity;  // with its unit
  double printed = 0.0;
  double ours = 0.0;
};

struct Figure {
  std::string name;  // of its files
  std::string of;    // "[2] fig. 3"
  std::string shows;
  std::vector<Printed> numbers;  // none: its document prints none
  report::Table curves;          // what the picture plots, NAME.csv
  report::Picture picture;
};

Figure rhombus_units();           // [1] figs. 5 to 7
Figure disc_layers();             // [2] fig. 3 and its worked example
Figure skin_rings();              // [3] fig. 5
Figure near_field_indentation();  // [3] fig. 6
Figure skin_press();              // [3] fig. 8
Figure euler_methods();           // [4] fig. 2
Figure alpha_search();            // [4] fig. 4
Figure alpha_curves();            // [4] fig. 5
Figure step_methods();            // [4] fig. 7
Figure step_sizes();              // [4] fig. 8

std::vector<Figure> all_figures();

/// One row for each printed number of all figures.
report::Table numbers_of(const std::vector<Figure>& figures);

/// Columns of numbers, job by job.
report::Table curves_of(const std::string& name, const std::vector<std::string>& columns,
                        std::vector<report::Row> rows);

}  // namespace tact::tools::figures
