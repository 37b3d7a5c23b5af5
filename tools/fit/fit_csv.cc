// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "model/io/csv.h"

namespace tact::tools::fit {
namespace {

using model::Error;
using model::Result;
using model::io::Csv;
using model::io::CsvLine;

// Chosen: fewer points than that fit anything.
constexpr std::size_t kMinRows = 3;
constexpr double kAsDeep = 1.0 + 1e-9;  // 9 times 0.001 is more than 0.009
constexpr const char* kRadius = "radius_m";

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
    // The row of radii, which find_rings has read.
    if (line.cells[*depth] == kRadius) continue;
    const auto depth_value = csv->number(line, *depth);
    if (!depth_value) return depth_value.error();
    const auto force_value = csv->number(line, *force);
    if (!force_value) return force_value.error();
    FitSample sample{.depth_m = *depth_value * columns.depth_unit_m,
                     .force_N = *force_value * columns.force_unit_N};
    // Millimetres taken for metres show here, before a fit runs for minutes on them.
    if (std::abs(sample.depth_m) > 0.5)
      return csv->blame(line.number, fmt::format("{} = {} is {} m deep; say what its unit is with "
                                                 "--depth-unit-m (0.001 for mm)",
                                                 columns.depth, *depth_value, sample.depth_m));
    if (sample.depth_m > columns.deepest_m * kAsDeep) continue;
    for (const std::size_t column : rings->column) {
      const auto u_m = csv->number(line, column);
      if (!u_m) return u_m.error();
      sample.ring_m.push_back(*u_m);
    }
    const std::string name = site_column ? line.cells[*site_column] : "bench";
    site_named(data.sites, name).samples.push_back(std::move(sample));
    ++rows;
  }
  if (rows < kMinRows)
    return Error{fmt::format("{}: {} rows; a fit needs {} at least", path, rows, kMinRows)};
  if (auto error = hold_out(data, held_out)) return std::move(*error);
  // Residuals are shares of the peak.
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

}  // namespace tact::tools::fit
