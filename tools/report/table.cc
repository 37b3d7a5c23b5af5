// SPDX-License-Identifier: Apache-2.0
#include "tools/report/table.h"

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "model/io/json.h"
#include "tools/report/csv.h"

namespace tact::tools::report {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;
using nlohmann::ordered_json;

std::string text_of(const Cell& cell) {
  if (const auto* word = std::get_if<std::string>(&cell)) return *word;
  const double number = std::get<double>(cell);
  // -0 and nan would differ between compilers
  if (std::isnan(number)) return "nan";
  return fmt::format("{:.6g}", number + 0.0);
}

/// The first line of a shard's CSV.
struct ShardLine {
  program::Shard shard;
  std::string table;
  std::size_t jobs = 0;
};

std::string text_of(const ShardLine& line) {
  return fmt::format("# shard {}/{} of {}, {} jobs", line.shard.index, line.shard.count, line.table,
                     line.jobs);
}

Result<ShardLine> read_shard_line(const std::string& path) {
  const auto text = model::io::read_file(path);
  if (!text) return text.error();
  std::istringstream stream(*text);
  std::string line, hash, shard_word, shard, of;
  std::getline(stream, line);
  std::istringstream words(line);
  ShardLine out;
  words >> hash >> shard_word >> shard >> of >> out.table >> out.jobs;
  const auto parsed = program::parse_shard(shard);
  if (!out.table.empty()) out.table.pop_back();  // the comma
  if (parsed) out.shard = *parsed;
  if (parsed && text_of(out) == line) return out;
  return Error{fmt::format("{}: is not the CSV of a shard; give what --shard i/n wrote", path)};
}

}  // namespace

Table::Table(std::string name, std::vector<Column> columns, std::size_t jobs, program::Shard shard)
    : name_(std::move(name)), columns_(std::move(columns)), jobs_(jobs), shard_(shard) {}

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
  std::string out;
  if (!shard_.is_whole()) out += text_of(ShardLine{shard_, name_, jobs_}) + "\n";
  out += "job";
  for (const Column& column : columns_) out += "," + column.name;
  out += "\n";
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    out += std::to_string(shard_.job(k));
    for (const Cell& cell : rows_[k]) out += "," + text_of(cell);
    out += "\n";
  }
  return out;
}

std::string Table::to_json() const {
  ordered_json rows = ordered_json::array();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    ordered_json row{{"job", shard_.job(k)}};
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
  const std::string csv_path =
      shard_.is_whole() ? stem + ".csv"
                        : fmt::format("{}.shard-{}-of-{}.csv", stem, shard_.index, shard_.count);
  if (auto error = keep(csv_path, to_csv())) return *error;
  if (!shard_.is_whole()) return files;
  if (auto error = keep(stem + ".json", to_json())) return *error;
  return files;
}

Result<std::string> table_of_file(const std::string& path) {
  const auto line = read_shard_line(path);
  if (!line) return line.error();
  return line->table;
}

namespace {

struct ReadRow {
  std::size_t job = 0;
  Row cells;
};

/// "3,1.5,rest" as the columns want it; nothing if it is torn.
std::optional<ReadRow> read_row(const std::string& line, const std::vector<Column>& columns) {
  const std::vector<std::string> parts = split_cells(line);
  if (parts.size() != columns.size() + 1) return std::nullopt;
  const auto job = number_in(parts[0]);
  if (!job || !(*job >= 0.0) || *job != std::floor(*job) || *job > 1e9) return std::nullopt;
  ReadRow out{.job = static_cast<std::size_t>(*job), .cells = {}};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& part = parts[i + 1];
    const auto number = number_in(part);
    if (columns[i].kind == CellKind::kNumber && !number) return std::nullopt;
    out.cells.push_back(columns[i].kind == CellKind::kWord ? Cell(part) : Cell(*number));
  }
  return out;
}

/// Why the shard at `path` is none of the others' table; `count`: of their shards, 0 at the first.
std::optional<Error> check_shard(const Table& empty, const std::string& path, const ShardLine& line,
                                 std::size_t count) {
  if (line.table != empty.name() || line.jobs != empty.jobs())
    return Error{
        fmt::format("{}: {} jobs of {}, but {} jobs of {} are wanted; merge with the "
                    "options that the shards were run with",
                    path, line.jobs, line.table, empty.jobs(), empty.name())};
  if (count != 0 && line.shard.count != count)
    return Error{fmt::format("{}: one of {} shards among files of {}; leave it out", path,
                             line.shard.count, count)};
  return std::nullopt;
}

}  // namespace

Result<Table> merge_table(const Table& empty, const std::vector<std::string>& files) {
  std::vector<std::optional<Row>> rows(empty.jobs());
  std::vector<std::string> from(empty.jobs());
  std::size_t count = 0;
  for (const std::string& path : files) {
    const auto line = read_shard_line(path);
    if (!line) return line.error();
    if (auto differs = check_shard(empty, path, *line, count)) return std::move(*differs);
    count = line->shard.count;
    const auto content = model::io::read_file(path);
    if (!content) return content.error();
    std::istringstream stream(*content);
    std::string text;
    std::getline(stream, text);
    std::getline(stream, text);
    if (text + "\n" != empty.to_csv())
      return Error{
          fmt::format("{}:2: other columns than this build has; run shard {}/{} again "
                      "with this build",
                      path, line->shard.index, count)};
    for (int number = 3; std::getline(stream, text); ++number) {
      auto row = read_row(text, empty.columns());
      const bool is_torn = stream.eof();  // the last line has an end too
      if (!row || is_torn || row->job >= rows.size() || !line->shard.owns(row->job))
        return Error{fmt::format("{}:{}: damaged row; run shard {}/{} again", path, number,
                                 line->shard.index, count)};
      if (rows[row->job])
        return Error{fmt::format("{}:{}: job {} is also in {}; give shard {}/{} once", path, number,
                                 row->job, from[row->job], line->shard.index, count)};
      from[row->job] = path;
      rows[row->job] = std::move(row->cells);
    }
  }
  Table whole = empty;
  for (std::size_t job = 0; job < rows.size(); ++job) {
    if (!rows[job])
      return Error{fmt::format("{}: job {} is missing; run shard {}/{} again or add its file",
                               empty.name(), job, job % std::max<std::size_t>(1, count), count)};
    whole.add(std::move(*rows[job]));
  }
  return whole;
}

}  // namespace tact::tools::report
