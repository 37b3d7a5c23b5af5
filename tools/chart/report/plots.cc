// SPDX-License-Identifier: Apache-2.0
// The chart as a picture: force error over time per tick, of the peak and of the own force at its
// worst, and shape error below.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tools/chart/report/report.h"
#include "tools/chart/report/scripts.h"
#include "tools/report/plot.h"

namespace tact::tools::chart {
namespace {

using model::Result;

constexpr double kMinError_ratio = 1e-4;  // what lies below is drawn there

// The panels: force of the peak, own force, shape.
constexpr std::array kErrors{"force_rms_ratio", "own_worst_ratio", "shape_rms_ratio"};
struct Point {
  double tick_us = 0.0;
  std::array<double, kErrors.size()> error_percent{};
  std::array<std::string, kErrors.size()> label{};
};
struct Family {
  std::string name;
  bool is_peer = false;
  std::vector<Point> points{};
};

/// gnuplot reads no underscore as such, and a label must be short: "65 knots" is 65.
std::string label(const std::string& size) {
  if (std::count(size.begin(), size.end(), ' ') > 1) return " ";  // two sizes: the legend is enough
  std::string out;
  for (const char c : size.substr(0, size.find(' '))) out += c == '_' ? '-' : c;
  return out;
}

std::string shown(const std::string& family) {
  std::string out = family;
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

double percent(double ratio) { return 100.0 * std::max(ratio, kMinError_ratio); }

std::vector<Family> families_of(const report::Table& table) {
  std::vector<Family> out;
  for (const report::Row& row : table.rows()) {
    Point p{.tick_us = number(row, "tick_median_us")};
    // A row that was not measured.
    if (!(p.tick_us > 0.0)) continue;
    const std::string& form = word(row, "form");
    std::string name = word(row, "family"), size = word(row, "size");
    if (form != "-") name += "_" + form;
    if (form != "-" && size.starts_with(form)) size = size.substr(form.size() + 1);
    for (std::size_t k = 0; k < kErrors.size(); ++k)
      p.error_percent[k] = percent(number(row, kErrors[k]));
    p.label.fill(label(size));
    auto family = std::ranges::find(out, name, &Family::name);
    if (family == out.end())
      family = out.insert(out.end(), {.name = name, .is_peer = word(row, "kind") == "peer"});
    family->points.push_back(std::move(p));
  }
  return out;
}

/// Sizes whose points lie on each other in a panel share one label there: "17..129".
void share_labels(std::vector<Point>& points, std::size_t panel) {
  constexpr double kSame = 0.1;  // of a decade
  for (std::size_t first = 0; first < points.size();) {
    const Point& p = points[first];
    const auto is_close = [&](const Point& other) {
      return std::abs(std::log10(other.tick_us / p.tick_us)) < kSame &&
             std::abs(std::log10(other.error_percent[panel] / p.error_percent[panel])) < kSame;
    };
    std::string& shared = points[first].label[panel];
    std::string last = shared;
    std::size_t end = first + 1;
    for (; end < points.size() && is_close(points[end]); ++end) {
      std::string own = std::exchange(points[end].label[panel], " ");
      if (own != " ") last = std::move(own);
    }
    if (last != shared) shared += ".." + last;
    first = end;
  }
}

/// Every point with its family's number.
std::string point_rows(std::vector<Family> families) {
  std::string out = "family,tick_us,force,own,shape,force_label,own_label,shape_label\n";
  for (std::size_t i = 0; i < families.size(); ++i) {
    for (std::size_t k = 0; k < kErrors.size(); ++k) share_labels(families[i].points, k);
    for (const Point& p : families[i].points)
      out += fmt::format("{},{:.6g},{:.6g},{}\n", i + 1, p.tick_us, fmt::join(p.error_percent, ","),
                         fmt::join(p.label, ","));
  }
  return out;
}

/// From the top, step by step, to the right edge: beyond the outermost points, where the axes cut.
std::string front_rows_of(const report::Table& table, double most_us, double most_force) {
  std::string out = "tick_us,force,law\n";
  double force = 0.0;
  for (const std::size_t i : front_rows(table)) {
    const report::Row& row = table.rows()[i];
    const double tick_us = number(row, "tick_median_us");
    if (force == 0.0) out += fmt::format("{:.6g},{:.6g}, \n", tick_us, 2.0 * most_force);
    force = percent(number(row, "force_rms_ratio"));
    out += fmt::format("{:.6g},{:.6g},{} {}\n", tick_us, force, shown(word(row, "family")),
                       word(row, "size"));
  }
  if (force > 0.0) out += fmt::format("{:.6g},{:.6g}, \n", 2.0 * most_us, force);
  return out;
}

}  // namespace

Result<std::vector<std::string>> draw_chart(const report::Table& table, const std::string& title,
                                            const std::string& directory) {
  const std::vector<Family> families = families_of(table);
  std::vector<std::string> names, is_peer;
  double least_us = 1e9, most_us = 0.0, most_force = 0.0;
  for (const Family& family : families) {
    names.push_back((family.is_peer ? "peer: " : "") + shown(family.name));
    is_peer.emplace_back(family.is_peer ? "1" : "0");
    for (const Point& p : family.points) {
      least_us = std::min(least_us, p.tick_us);
      most_us = std::max(most_us, p.tick_us);
      most_force = std::max(most_force, p.error_percent.front());
    }
  }
  return report::draw({.name = "chart",
                       .width_px = 1200,
                       .height_px = 1200,
                       .script = kChartScript,
                       .variables = {{"caption", title},
                                     {"families", names},
                                     {"is_peer", is_peer},
                                     {"$points", point_rows(families)},
                                     {"$front", front_rows_of(table, most_us, most_force)},
                                     {"least_us", least_us},
                                     {"most_us", most_us},
                                     {"most_force", most_force},
                                     {"peers", source_of_peers(table)}}},
                      directory);
}

}  // namespace tact::tools::chart
