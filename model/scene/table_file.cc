// SPDX-License-Identifier: Apache-2.0
#include "model/scene/table_file.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "model/io/csv.h"

namespace tact::model::scene {
namespace {

struct Unit {
  const char* column;
  double in_si;
};

/// The first of the columns that the file has.
Result<std::pair<std::size_t, double>> find_one(const io::Csv& csv,
                                                const std::array<Unit, 2>& units) {
  for (const Unit& unit : units)
    if (const auto column = csv.find(unit.column)) return std::pair{*column, unit.in_si};
  return csv.blame(csv.header_line(),
                   fmt::format("no column {} or {}; write their names as the first line, "
                               "\"depth_mm,force_N\"",
                               units[0].column, units[1].column));
}

}  // namespace

Result<std::vector<indent::TableRow>> read_table_file(const std::string& path) {
  const auto csv = io::Csv::read(path);
  if (!csv) return csv.error();
  const auto depth = find_one(*csv, {{{"depth_mm", 1e-3}, {"depth_m", 1.0}}});
  if (!depth) return depth.error();
  const auto force = find_one(*csv, {{{"force_N", 1.0}, {"force_mN", 1e-3}}});
  if (!force) return force.error();
  std::vector<indent::TableRow> rows;
  for (const io::CsvLine& line : csv->rows()) {
    const auto d = csv->number(line, depth->first);
    if (!d) return d.error();
    const auto f = csv->number(line, force->first);
    if (!f) return f.error();
    rows.push_back({line.number, *d * depth->second, *f * force->second});
  }
  return rows;
}

}  // namespace tact::model::scene
