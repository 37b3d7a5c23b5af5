// SPDX-License-Identifier: Apache-2.0
#include "model/io/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "model/io/input_file.h"

namespace tact::model::io {

namespace {

/// Between commas, without blanks around and quotes within.
std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    std::string cell = line.substr(at, comma - at);
    std::erase(cell, '"');
    cell.erase(0, cell.find_first_not_of(" \t\r"));
    cell.erase(cell.find_last_not_of(" \t\r") + 1);
    cells.push_back(std::move(cell));
    at = comma + 1;
  }
  return cells;
}

}  // namespace

std::optional<double> number_in(const std::string& cell) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

std::optional<std::size_t> Csv::find(const std::string& name) const {
  const auto at = std::find(header_.cells.begin(), header_.cells.end(), name);
  if (at == header_.cells.end()) return std::nullopt;
  return static_cast<std::size_t>(at - header_.cells.begin());
}

Error Csv::blame(int line, const std::string& what) const {
  return {fmt::format("{}:{}: {}", path_, line, what)};
}

Result<Csv> Csv::read(const std::string& path) {
  const auto content = read_file(path);
  if (!content) return content.error();
  std::istringstream file(*content);
  Csv csv;
  csv.path_ = path;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    if (number == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // byte order mark
    if (text.empty() || text[0] == '#' || text == "\r") continue;
    CsvLine line{.number = number, .cells = split_cells(text)};
    if (csv.header_.cells.empty()) {
      csv.header_ = std::move(line);
      continue;
    }
    if (line.cells.size() != csv.header_.cells.size())
      return csv.blame(
          number, fmt::format("{} values, but line {} names {} columns; write one "
                              "value for each",
                              line.cells.size(), csv.header_.number, csv.header_.cells.size()));
    csv.rows_.push_back(std::move(line));
  }
  if (csv.header_.cells.empty()) return Error{fmt::format("{}: is empty; check the name", path)};
  return csv;
}

Result<std::size_t> Csv::need(const std::string& name, const std::string& option) const {
  if (const auto column = find(name)) return *column;
  return blame(header_.number, fmt::format("no column {} among {}; name it with {}", name,
                                           fmt::join(header_.cells, ", "), option));
}

Result<double> Csv::number(const CsvLine& line, std::size_t column) const {
  const std::string& cell = line.cells[column];
  const auto value = number_in(cell);
  if (value && std::isfinite(*value)) return *value;
  return blame(line.number, fmt::format("{}: \"{}\" is no number", header_.cells[column], cell));
}

}  // namespace tact::model::io
