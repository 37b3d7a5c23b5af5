// SPDX-License-Identifier: Apache-2.0
#include "tools/report/table.h"

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/io/file_writer.h"
#include "model/io/json.h"
#include "tools/report/csv.h"

namespace tact::tools::report {
namespace {

namespace fs = std::filesystem;
using model::Result;
using nlohmann::ordered_json;

std::string text_of(const Cell& cell) {
  if (const auto* word = std::get_if<std::string>(&cell)) return *word;
  const double number = std::get<double>(cell);
  // -0 and nan would differ between compilers
  if (std::isnan(number)) return "nan";
  return fmt::format("{:.6g}", number + 0.0);
}

}  // namespace

std::size_t Table::column(const std::string& name) const {
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (columns_[i].name == name) return i;
  assert(false && "no such column");
  return 0;
}

double Table::number(const Row& row, const std::string& column_name) const {
  return std::get<double>(row[column(column_name)]);
}

const std::string& Table::word(const Row& row, const std::string& column_name) const {
  return std::get<std::string>(row[column(column_name)]);
}

std::string Table::to_csv() const {
  std::string out = "job";
  for (const Column& column : columns_) out += "," + column.name;
  out += "\n";
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    out += std::to_string(k);
    for (const Cell& cell : rows_[k]) out += "," + text_of(cell);
    out += "\n";
  }
  return out;
}

std::string Table::to_json() const {
  ordered_json rows = ordered_json::array();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    ordered_json row{{"job", k}};
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string text = text_of(rows_[k][i]);
      if (columns_[i].kind == CellKind::kWord) {
        row[columns_[i].name] = text;
      } else {
        const double number = *number_in(text);  // of the text: CSV and JSON agree
        row[columns_[i].name] = std::isfinite(number) ? ordered_json(number) : ordered_json(text);
      }
    }
    rows.push_back(std::move(row));
  }
  return model::io::text_of(ordered_json{{"table", name_}, {"rows", rows}}, 1) + "\n";
}

Result<std::vector<std::string>> Table::write(const std::string& directory) const {
  const std::string stem = (fs::path(directory) / name_).string();
  std::vector<std::string> files;
  const auto keep = [&](const std::string& path, const std::string& content) {
    files.push_back(path);
    return model::io::write_file(path, content);
  };
  if (auto error = keep(stem + ".csv", to_csv())) return *error;
  if (auto error = keep(stem + ".json", to_json())) return *error;
  return files;
}

}  // namespace tact::tools::report
