// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/report/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/chart/compare/chart.h"
#include "tools/chart/report/report.h"
#include "tools/report/picture.h"

namespace tact::tools::chart {
namespace {

using model::Result;

constexpr double kMinError_ratio = 1e-4;  // what lies below is drawn there

struct Point {
  double tick_us = 0.0, force = 0.0, own = 0.0, shape = 0.0;  // errors in %
  std::string size;
};
struct Panel {
  double Point::* error;
  int first_block;  // of the data
};
constexpr Panel kForce{&Point::force, 0}, kOwn{&Point::own, 100}, kShape{&Point::shape, 200};

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

struct Families {
  std::vector<std::string> order;
  std::map<std::string, std::vector<Point>> points;
  std::map<std::string, bool> is_peer;
  double least_us = 1e9, most_us = 0.0, most_force = 0.0;  // of all points
};

Families families_of(const report::Table& table) {
  Families out;
  for (const report::Row& row : table.rows()) {
    const double tick_us = table.number(row, "tick_median_us");
    // A row that was not measured.
    if (!(tick_us > 0.0)) continue;
    std::string family = table.word(row, "family");
    const std::string& form = table.word(row, "form");
    if (form != "-") family += "_" + form;
    if (!out.points.contains(family)) out.order.push_back(family);
    out.is_peer[family] = table.word(row, "kind") == "peer";
    std::string size = table.word(row, "size");
    if (form != "-" && size.starts_with(form)) size = size.substr(form.size() + 1);
    const Point p{tick_us, percent(table.number(row, "force_rms_ratio")),
                  percent(table.number(row, "own_worst_ratio")),
                  percent(table.number(row, "shape_rms_ratio")), label(size)};
    out.points[family].push_back(p);
    out.least_us = std::min(out.least_us, p.tick_us);
    out.most_us = std::max(out.most_us, p.tick_us);
    out.most_force = std::max(out.most_force, p.force);
  }
  return out;
}

/// Sizes whose points lie on each other share one label: "17..129".
void share_labels(std::vector<Point>& points, double Point::* error) {
  constexpr double kSame = 0.1;  // of a decade
  for (std::size_t first = 0; first < points.size();) {
    std::size_t end = first + 1;
    const auto is_close = [&](const Point& p) {
      return std::abs(std::log10(p.tick_us / points[first].tick_us)) < kSame &&
             std::abs(std::log10(p.*error / (points[first].*error))) < kSame;
    };
    while (end < points.size() && is_close(points[end])) ++end;
    std::string last = points[first].size;
    for (std::size_t i = first; i < end; ++i)
      if (points[i].size != " ") last = points[i].size;
    if (last != points[first].size) points[first].size += ".." + last;
    for (std::size_t i = first + 1; i < end; ++i) points[i].size.assign(1, ' ');
    first = end;
  }
}

/// The line that no law of tact passes: from the top, step by step, to the right edge.
std::vector<Point> front_points(const report::Table& table, const Families& families) {
  std::vector<Point> out;
  for (const std::size_t i : front_rows(table)) {
    const report::Row& row = table.rows()[i];
    out.push_back(
        {table.number(row, "tick_median_us"), percent(table.number(row, "force_rms_ratio")), 0.0,
         0.0, fmt::format("{} {}", shown(table.word(row, "family")), table.word(row, "size"))});
  }
  if (out.empty()) return out;
  // Beyond the outermost points, where the axes cut it.
  out.insert(out.begin(), {out.front().tick_us, 2.0 * families.most_force, 0.0, 0.0, " "});
  out.push_back({2.0 * families.most_us, out.back().force, 0.0, 0.0, " "});
  return out;
}

/// The first one has the front and the legend.
std::string plot_of(const Families& families, const Panel& panel) {
  const bool is_first = panel.first_block == kForce.first_block;
  std::string out = "plot ";
  if (is_first)
    out +=
        "$front using 1:2 with steps lw 4 lc rgb '#c8c8c8' title 'front of tact', "
        "$front using 1:2:4 with labels left offset 3,-1.2 font ',10' tc rgb '#555555' notitle, ";
  int law = 0, peer = 0;
  for (std::size_t i = 0; i < families.order.size(); ++i) {
    const std::string& family = families.order[i];
    const bool is_peer = families.is_peer.at(family);
    // Warm inks are peers, cold ones laws.
    static constexpr const char* kPeerInk[] = {"#D55E00", "#CC3311", "#882255", "#E69F00"};
    static constexpr const char* kLawInk[] = {"#0072B2", "#009E73", "#56B4E9", "#004D73",
                                              "#6A3D9A", "#44AA99", "#332288"};
    const char* ink = is_peer ? kPeerInk[peer % 4] : kLawInk[law % 7];
    const int symbol = is_peer ? 5 + 2 * (peer % 4) : 4 + law % 5 * 2;
    (is_peer ? peer : law) += 1;
    const std::string title =
        is_first ? fmt::format("title '{}{}'", is_peer ? "peer: " : "", shown(family)) : "notitle";
    const char* side = i % 2 == 0 ? "left offset 0.8,0.4" : "left offset 0.8,-0.4";
    out += fmt::format(
        "{0}$data{1} using 1:2 with linespoints pt {2} ps 1.3 lw 1 dt 3 lc rgb '{3}' {4}, "
        "$data{1} using 1:2:4 with labels {5} font ',8' tc rgb '{3}' notitle",
        i == 0 ? "" : ", ", static_cast<int>(i) + panel.first_block, symbol, ink, title, side);
  }
  return out + "\n";
}

std::string data_blocks(const Families& families) {
  std::string out;
  for (std::size_t i = 0; i < families.order.size(); ++i)
    for (const Panel& panel : {kForce, kOwn, kShape}) {
      auto points = families.points.at(families.order[i]);
      share_labels(points, panel.error);
      out += fmt::format("$data{} << EOD\ntick_us,error_percent,x,size\n",
                         static_cast<int>(i) + panel.first_block);
      for (const Point& p : points)
        out += fmt::format("{:.6g},{:.6g},0,{}\n", p.tick_us, p.*panel.error, p.size);
      out += "EOD\n";
    }
  return out;
}

}  // namespace

Result<std::vector<std::string>> draw_chart(const report::Table& table, const std::string& title,
                                            const std::string& directory) {
  const Families families = families_of(table);
  std::string script = data_blocks(families);
  script += "$front << EOD\ntick_us,force,x,size\n";
  for (const Point& p : front_points(table, families))
    script += fmt::format("{:.6g},{:.6g},0,{}\n", p.tick_us, p.force, p.size);
  script += "EOD\n";
  script += fmt::format(
      "set multiplot title '{}'\n"
      "set logscale xy\n"
      "set xrange [{:.3g}:{:.3g}]\nset yrange [*:{:.3g}]\n"
      "set format x '%g'\nset format y '%g'\n"
      "set key outside right top font ',9' Left reverse\n"
      "set lmargin 9\nset rmargin 28\n"
      "set size 1,0.46\nset origin 0,0.5\n"
      "set ylabel 'force error, RMS, % of the peak'\n"
      "set label 1 'a hand can tell a difference of 7 %' at graph 0.5, first 7 center offset 0,0.5 "
      "font ',8' tc rgb '#555555'\n"
      "set arrow 1 from graph 0, first 7 to graph 1, first 7 nohead dt 2 lc rgb '#555555'\n",
      title, families.least_us / 6.0, 3.0 * families.most_us, 2.0 * families.most_force);
  script += plot_of(families, kForce);
  script +=
      "unset label 1\n"
      "set yrange [*:*]\n"
      "set size 1,0.25\nset origin 0,0.25\n"
      "set ylabel 'worst, % of the own force'\n";
  script += plot_of(families, kOwn);
  script +=
      "unset arrow 1\n"
      "set size 1,0.25\nset origin 0,0\n"
      "set xlabel \"time of a tick, median, us; of a law: detect, render, limit of the whole "
      "tool\\n"
      "beside a point: knots, layers, rings, nodes, curves; of fem mm, else iterations\\n" +
      source_of_peers(table) + "\"\nset ylabel 'shape error, RMS, %'\n";
  script += plot_of(families, kShape);
  script += "unset multiplot\n";
  return report::draw({.name = "chart", .width_px = 1200, .height_px = 1200, .script = script},
                      directory);
}

}  // namespace tact::tools::chart
