// SPDX-License-Identifier: Apache-2.0
// table.h - a table of results: one row per job, named columns with units, as CSV and as JSON.
//
// Every row begins with the number of its job. Numbers are kept to six significant digits, so CSV
// and JSON agree. Words hold no comma, quote or line end.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "model/result.h"

namespace tact::tools::report {

enum class CellKind { kNumber, kWord };

struct Column {
  std::string name;  // ends in its unit, as everywhere
  CellKind kind = CellKind::kNumber;
};

using Cell = std::variant<double, std::string>;
using Row = std::vector<Cell>;  // without the job

class Table {
 public:
  Table(std::string name, std::vector<Column> columns)
      : name_(std::move(name)), columns_(std::move(columns)) {}

  void add(Row row) { rows_.push_back(std::move(row)); }

  const std::string& name() const { return name_; }
  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<Row>& rows() const { return rows_; }
  /// Where this column stands in a row; an assert if there is none.
  std::size_t column(const std::string& name) const;
  double number(const Row& row, const std::string& column_name) const;
  const std::string& word(const Row& row, const std::string& column_name) const;

  std::string to_csv() const;
  std::string to_json() const;
  /// NAME.csv and NAME.json. Returns what it wrote.
  model::Result<std::vector<std::string>> write(const std::string& directory) const;

 private:
  std::string name_;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

}  // namespace tact::tools::report
