// SPDX-License-Identifier: Apache-2.0
#include "tools/report/table.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/io/csv.h"
#include "model/io/file_writer.h"
#include "model/io/json.h"

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

std::string Table::to_csv() const {
  std::string out = "job";
  if (!rows_.empty())
    for (const auto& [column, cell] : rows_.front()) out += std::string(",") + column;
  out += "\n";
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    out += std::to_string(k);
    for (const auto& [column, cell] : rows_[k]) out += "," + text_of(cell);
    out += "\n";
  }
  return out;
}

std::string Table::to_json() const {
  ordered_json rows = ordered_json::array();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    ordered_json row{{"job", k}};
    for (const auto& [column, cell] : rows_[k]) {
      const std::string text = text_of(cell);
      row[column] = text;
      if (std::holds_alternative<std::string>(cell)) continue;
      const double number = *model::io::number_in(text);  // of the text: CSV and JSON agree
      if (std::isfinite(number)) row[column] = number;
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
