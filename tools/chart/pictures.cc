#include "tools/chart/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/chart/chart.h"
#include "tools/common/picture.h"

namespace tact::tools {
namespace {

using model::Result;

constexpr double kLeastError_ratio = 1e-4;  // what lies below is drawn there

struct Point {
  double tick_us = 0.0, force = 0.0, shape = 0.0;  // errors in %
  std::string size;
};

/// gnuplot reads no underscore as such, and a label must be short: "65 knots" is 65.
std::string label(const std::string& size) {
  std::string out;
  for (const char c : size.substr(0, size.find(' '))) out += c == '_' ? '-' : c;
  return out;
}

std::string shown(const std::string& family) {
  std::string out = family;
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

double percent(double ratio) { return 100.0 * std::max(ratio, kLeastError_ratio); }

std::string block(const std::string& name, const std::vector<Point>& points) {
  std::string out = fmt::format("${} << EOD\ntick_us,force,shape,size\n", name);
  for (const Point& p : points)
    out += fmt::format("{:.6g},{:.6g},{:.6g},{}\n", p.tick_us, p.force, p.shape, p.size);
  return out + "EOD\n";
}

struct Families {
  std::vector<std::string> order;
  std::map<std::string, std::vector<Point>> points;
  std::map<std::string, bool> is_peer;
};

Families families_of(const Table& table) {
  Families out;
  for (const Row& row : table.rows()) {
    const double tick_us = table.number(row, "tick_median_us");
    if (!(tick_us > 0.0)) continue;
    std::string family = table.word(row, "family");
    const std::string& form = table.word(row, "form");
    if (form != "-") family += "_" + form;
    if (!out.points.contains(family)) out.order.push_back(family);
    out.is_peer[family] = table.word(row, "kind") == "peer";
    std::string size = table.word(row, "size");
    if (form != "-" && size.starts_with(form)) size = size.substr(form.size() + 1);
    out.points[family].push_back({tick_us, percent(table.number(row, "force_rms_ratio")),
                                  percent(table.number(row, "shape_rms_ratio")), label(size)});
  }
  return out;
}

std::vector<Point> front_points(const Table& table) {
  std::vector<Point> out;
  for (const std::size_t i : front_rows(table)) {
    const Row& row = table.rows()[i];
    out.push_back({table.number(row, "tick_median_us"),
                   percent(table.number(row, "force_rms_ratio")),
                   percent(table.number(row, "shape_rms_ratio")), ""});
  }
  return out;
}

/// One panel: column 2 or 3 of the data over column 1.
std::string panel(const Families& families, int column, bool with_front) {
  std::string out = "plot ";
  if (with_front) out += "$front using 1:2 with steps lw 3 lc rgb '#bbbbbb' title 'front of tact'";
  int law = 0, peer = 0;
  for (std::size_t i = 0; i < families.order.size(); ++i) {
    const std::string& family = families.order[i];
    const bool is_peer = families.is_peer.at(family);
    static constexpr const char* kPeerInk[] = {"#D55E00", "#CC3311", "#A52A2A", "#E69F00"};
    static constexpr const char* kLawInk[] = {"#0072B2", "#009E73", "#56B4E9", "#004D73",
                                              "#6A3D9A", "#44AA99", "#332288"};
    const char* ink = is_peer ? kPeerInk[peer % 4] : kLawInk[law % 7];
    const int symbol = is_peer ? 5 + 2 * (peer % 4) : 4 + law % 7 * 2;
    (is_peer ? peer : law) += 1;
    const std::string title =
        column == 2 ? fmt::format("'{}{}'", is_peer ? "peer: " : "", shown(family)) : "''";
    out += fmt::format(
        "{0}$family{1} using 1:{2} with linespoints pt {3} ps 1.2 lw 1 dt 3 lc rgb '{4}' title {5}"
        ", $family{1} using 1:{2}:4 with labels left offset 0.6,0.5 font ',8' tc rgb '{4}' "
        "notitle",
        out.back() == ' ' ? "" : ", ", i, column, symbol, ink, title);
  }
  return out + "\n";
}

}  // namespace

Result<std::vector<std::string>> draw_chart(const Table& table, const std::string& title,
                                            const std::string& directory) {
  const Families families = families_of(table);
  std::string script;
  for (std::size_t i = 0; i < families.order.size(); ++i)
    script += block(fmt::format("family{}", i), families.points.at(families.order[i]));
  script += block("front", front_points(table));
  script += fmt::format(
      "set multiplot title '{}'\n"
      "set logscale xy\n"
      "set xrange [0.01:*]\n"
      "set format x '%g'\n"
      "set key outside right top font ',9'\n"
      "set lmargin 9\nset rmargin 26\n"
      "set size 1,0.62\nset origin 0,0.34\n"
      "set ylabel 'force error, RMS, % of the peak'\n"
      "set label 1 'a hand feels no difference below 7 %' at graph 0.01, first 7.6 font ',8' "
      "tc rgb '#555555'\n"
      "set arrow 1 from graph 0, first 7 to graph 1, first 7 nohead dt 2 lc rgb '#555555'\n",
      title);
  script += panel(families, 2, true);
  script +=
      "unset label 1\nunset arrow 1\n"
      "set size 1,0.34\nset origin 0,0\n"
      "set xlabel 'time of a tick, median, {/Symbol m}s  (number at a point: its size)'\n"
      "set ylabel 'shape error, RMS, %'\n";
  script += panel(families, 3, false);
  script += "unset multiplot\n";
  return draw({.name = "chart", .width_px = 1200, .height_px = 1000, .script = script}, directory);
}

}  // namespace tact::tools
