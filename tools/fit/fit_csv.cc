#include "tools/fit/fit_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>

namespace tact::tools {
namespace {

using model::Error;
using model::Result;

constexpr std::size_t kFewestRows = 3;
constexpr const char* kRadius = "radius_m";

struct CsvLine {
  int number = 0;  // from 1
  std::vector<std::string> cells;
};

/// A header and its rows, all of one width; knows its file for the errors.
class Csv {
 public:
  static Result<Csv> read(const std::string& path);

  std::optional<std::size_t> find(const std::string& name) const {
    const auto at = std::find(header_.cells.begin(), header_.cells.end(), name);
    if (at == header_.cells.end()) return std::nullopt;
    return static_cast<std::size_t>(at - header_.cells.begin());
  }
  Result<std::size_t> need(const std::string& name, const std::string& option) const;
  Result<double> number(const CsvLine& line, std::size_t column) const;
  Error blame(int line, const std::string& what) const {
    return {fmt::format("{}:{}: {}", path_, line, what)};
  }
  const std::vector<CsvLine>& rows() const { return rows_; }
  int header_line() const { return header_.number; }

 private:
  std::string path_;
  CsvLine header_;
  std::vector<CsvLine> rows_;
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != ' ' && c != '\t' && c != '\r' && c != '"') {
      cells.back() += c;
    }
  }
  return cells;
}

Result<Csv> Csv::read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Csv csv;
  csv.path_ = path;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    if (number == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // byte order mark
    if (text.empty() || text[0] == '#' || text == "\r") continue;
    CsvLine line{.number = number, .cells = split(text)};
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
  if (csv.header_.cells.empty())
    return Error{fmt::format("{}: cannot be read or is empty; check the name", path)};
  return csv;
}

Result<std::size_t> Csv::need(const std::string& name, const std::string& option) const {
  if (const auto column = find(name)) return *column;
  return blame(header_.number, fmt::format("no column {} among {}; name it with {}", name,
                                           fmt::join(header_.cells, ", "), option));
}

Result<double> Csv::number(const CsvLine& line, std::size_t column) const {
  const std::string& cell = line.cells[column];
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(value))
    return value;
  return blame(line.number, fmt::format("{}: \"{}\" is no number", header_.cells[column], cell));
}

struct RingColumns {
  std::vector<std::size_t> column;
  std::vector<double> radius_m;
};

/// u_0_m, u_1_m, ... and the row of their radii.
Result<RingColumns> find_rings(const Csv& csv, std::size_t depth) {
  RingColumns rings;
  for (std::size_t k = 0;; ++k) {
    const auto column = csv.find(fmt::format("u_{}_m", k));
    if (!column) break;
    rings.column.push_back(*column);
  }
  if (rings.column.empty()) return rings;
  if (csv.rows().empty() || csv.rows()[0].cells[depth] != kRadius)
    return csv.blame(csv.header_line(),
                     "columns u_0_m, ... need their radii: write a row that begins with radius_m "
                     "below the header");
  const CsvLine& line = csv.rows()[0];
  for (const std::size_t column : rings.column) {
    const auto radius_m = csv.number(line, column);
    if (!radius_m) return radius_m.error();
    if (*radius_m < 0.0 || (!rings.radius_m.empty() && *radius_m <= rings.radius_m.back()))
      return csv.blame(line.number, "the radii must rise from 0");
    rings.radius_m.push_back(*radius_m);
  }
  return rings;
}

FitSite& site_named(std::vector<FitSite>& sites, const std::string& name) {
  for (FitSite& site : sites)
    if (site.name == name) return site;
  return sites.emplace_back(FitSite{.name = name});
}

}  // namespace

Result<FitData> read_bench_csv(const std::string& path, const BenchColumns& columns,
                               const std::vector<std::string>& held_out) {
  const auto csv = Csv::read(path);
  if (!csv) return csv.error();
  const auto depth = csv->need(columns.depth, "--depth-column");
  if (!depth) return depth.error();
  const auto force = csv->need(columns.force, "--force-column");
  if (!force) return force.error();
  const auto rings = find_rings(*csv, *depth);
  if (!rings) return rings.error();
  const auto site_column = csv->find("site");

  FitData data{.source = path, .ring_radius_m = rings->radius_m};
  std::size_t rows = 0;
  for (const CsvLine& line : csv->rows()) {
    if (line.cells[*depth] == kRadius) continue;
    const auto depth_value = csv->number(line, *depth);
    if (!depth_value) return depth_value.error();
    const auto force_value = csv->number(line, *force);
    if (!force_value) return force_value.error();
    FitSample sample{.depth_m = *depth_value * columns.depth_unit_m,
                     .force_N = *force_value * columns.force_unit_N};
    if (std::abs(sample.depth_m) > 0.5)
      return csv->blame(line.number, fmt::format("{} = {} is {} m deep; say what its unit is with "
                                                 "--depth-unit-m (0.001 for mm)",
                                                 columns.depth, *depth_value, sample.depth_m));
    for (const std::size_t column : rings->column) {
      const auto u_m = csv->number(line, column);
      if (!u_m) return u_m.error();
      sample.ring_m.push_back(*u_m);
    }
    const std::string name = site_column ? line.cells[*site_column] : "bench";
    site_named(data.sites, name).samples.push_back(std::move(sample));
    ++rows;
  }
  if (rows < kFewestRows)
    return Error{fmt::format("{}: {} rows; a fit needs {} at least", path, rows, kFewestRows)};
  if (auto error = hold_out(data, held_out)) return std::move(*error);
  if (!(data.peak_N() > 0.0))
    return Error{fmt::format("{}: every force is 0; nothing can be fitted to that", path)};
  return data;
}

Result<std::vector<HeldForce>> read_relaxation_csv(const std::string& path,
                                                   const BenchColumns& columns) {
  const auto csv = Csv::read(path);
  if (!csv) return csv.error();
  const auto time = csv->need(columns.time, "--time-column");
  if (!time) return time.error();
  const auto force = csv->need(columns.force, "--force-column");
  if (!force) return force.error();
  std::vector<HeldForce> held;
  for (const CsvLine& line : csv->rows()) {
    const auto t = csv->number(line, *time);
    if (!t) return t.error();
    const auto f = csv->number(line, *force);
    if (!f) return f.error();
    if (!held.empty() && !(*t * columns.time_unit_s > held.back().time_s))
      return csv->blame(line.number, fmt::format("{} does not rise; sort the rows", columns.time));
    held.push_back({.time_s = *t * columns.time_unit_s, .force_N = *f * columns.force_unit_N});
  }
  return held;
}

}  // namespace tact::tools
