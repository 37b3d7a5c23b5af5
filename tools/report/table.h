// SPDX-License-Identifier: Apache-2.0
// table.h - a table of results: one row per job, named columns with units, as CSV and as JSON.
//
// Every row begins with the number of its job. Numbers are kept to six significant digits, so CSV
// and JSON agree. Words hold no comma, quote or line end.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "model/result.h"

namespace tact::tools::report {

/// A number or a word; a truth is 1 or 0.
struct Cell : std::variant<double, std::string> {
  template <typename T>
    requires std::is_arithmetic_v<T>
  Cell(T number) : variant(static_cast<double>(number)) {}
  Cell(std::string word) : variant(std::move(word)) {}
  Cell(const char* word) : variant(std::string(word)) {}
};
/// Without the job. Each cell with the name of its column, which ends in its unit, as everywhere.
using Row = std::vector<std::pair<const char*, Cell>>;

class Table {
 public:
  explicit Table(std::string name, std::vector<Row> rows = {})
      : name_(std::move(name)), rows_(std::move(rows)) {}

  /// With the columns of the first row, in their order.
  void add(Row row) { rows_.push_back(std::move(row)); }

  const std::string& name() const { return name_; }
  const std::vector<Row>& rows() const { return rows_; }

  std::string to_csv() const;
  std::string to_json() const;
  /// NAME.csv and NAME.json. Returns what it wrote.
  model::Result<std::vector<std::string>> write(const std::string& directory) const;

 private:
  std::string name_;
  std::vector<Row> rows_;
};

}  // namespace tact::tools::report
