// SPDX-License-Identifier: Apache-2.0
// csv.h - rows of comma-separated cells, of a bench's file from elsewhere.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/result.h"

namespace tact::model::io {

/// All of the cell; nan and inf too.
std::optional<double> number_in(const std::string& cell);

struct CsvLine {
  int number = 0;  // from 1
  std::vector<std::string> cells;
};

/// A header and its rows, all of one width; knows its file for the errors. Empty lines, lines that
/// begin with # and a byte order mark are passed over.
class Csv {
 public:
  static Result<Csv> read(const std::string& path);

  std::optional<std::size_t> find(const std::string& name) const;
  /// Error: no such column; `option` is what names it.
  Result<std::size_t> need(const std::string& name, const std::string& option) const;
  /// Error: no number, or not finite.
  Result<double> number(const CsvLine& line, std::size_t column) const;
  /// "file:line: what".
  Error blame(int line, const std::string& what) const;
  const std::vector<CsvLine>& rows() const { return rows_; }
  int header_line() const { return header_.number; }

 private:
  std::string path_;
  CsvLine header_;
  std::vector<CsvLine> rows_;
};

}  // namespace tact::model::io
