// SPDX-License-Identifier: Apache-2.0
#include "tools/figures/figures.h"

#include <utility>

namespace tact::tools::figures {

using report::CellKind;
using report::Table;

std::vector<Figure> all_figures() {
  return {rhombus_units(), disc_layers(),  skin_rings(),   near_field_indentation(), skin_press(),
          euler_methods(), alpha_search(), alpha_curves(), step_methods(),           step_sizes()};
}

Table numbers_of(const std::vector<Figure>& figures) {
  Table table("numbers", {{"figure", CellKind::kWord},
                          {"quantity", CellKind::kWord},
                          {"printed"},
                          {"tact"},
                          {"difference_percent"}});
  for (const Figure& figure : figures)
    for (const Printed& n : figure.numbers)
      table.add({figure.of, n.quantity, n.printed, n.ours, 100.0 * (n.ours / n.printed - 1.0)});
  return table;
}

Table curves_of(const std::string& name, const std::vector<std::string>& columns,
                std::vector<report::Row> rows) {
  std::vector<report::Column> named;
  named.reserve(columns.size());
  for (const std::string& column : columns) named.push_back({column});
  Table table(name, std::move(named));
  for (report::Row& row : rows) table.add(std::move(row));
  return table;
}

}  // namespace tact::tools::figures
