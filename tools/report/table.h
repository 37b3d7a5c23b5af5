// SPDX-License-Identifier: Apache-2.0
// table.h - a table of results: one row per job, named columns with units, as CSV and as JSON.
//
// Every row begins with the number of its job. The CSV of a shard says so in a first line
//
//     # shard 1/4 of loop, 960 jobs
//
// which a whole table does not have; merge() puts shards together again and gives the same bytes as
// one run of everything. Numbers are kept to six significant digits, so CSV, JSON and a merged
// table agree. Words hold no comma, quote or line end.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "model/result.h"
#include "tools/program/sweep.h"

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
  /// `jobs`: how many rows the whole table has.
  Table(std::string name, std::vector<Column> columns, std::size_t jobs, program::Shard shard = {});

  /// Rows in the order of the shard's jobs.
  void add(Row row) { rows_.push_back(std::move(row)); }

  const std::string& name() const { return name_; }
  std::size_t jobs() const { return jobs_; }
  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<Row>& rows() const { return rows_; }
  /// Where this column stands in a row; an assert if there is none.
  std::size_t column(const std::string& name) const;
  double number(const Row& row, const std::string& column_name) const;
  const std::string& word(const Row& row, const std::string& column_name) const;

  std::string to_csv() const;
  std::string to_json() const;
  /// NAME.csv and NAME.json; a shard writes NAME.shard-i-of-n.csv alone. Returns what it wrote.
  model::Result<std::vector<std::string>> write(const std::string& directory) const;

 private:
  std::string name_;
  std::vector<Column> columns_;
  std::size_t jobs_;
  program::Shard shard_;
  std::vector<Row> rows_;
};

/// The whole table from the CSVs of all its shards. A row that is missing or there twice is an
/// error that names the shard to run again.
model::Result<Table> merge_table(const Table& empty, const std::vector<std::string>& files);

/// Name of the table that a shard's CSV belongs to.
model::Result<std::string> table_of_file(const std::string& path);

}  // namespace tact::tools::report
