// SPDX-License-Identifier: Apache-2.0
// One panel a case: what was commanded, what the gate let through, what the device was handed, and
// the limit as two lines. Gnuplot reads the traces beside the picture.
#include <fmt/format.h>

#include <algorithm>

#include "tools/limits/report/report.h"
#include "tools/report/picture.h"

namespace tact::tools::limits {
namespace {

using model::Result;

// Twelve panels fill an A4 page, and their words are still read there.
constexpr std::size_t kColumns = 2, kPanels = 12;
constexpr int kPanelHeight_px = 190, kWidth_px = 900, kHead_px = 30;

/// Has it a moment to mark?
bool has_cause(const Case& c) {
  return c.trouble != Trouble::kNone || c.shape == Shape::kNan || c.shape == Shape::kInfinity;
}

std::string panel(const CaseResult& result) {
  const CaseVerdict& v = result.verdict;
  // of torque and force the one that the case drives to its limit
  const bool torque =
      v.subject.grip == Grip::kLever && v.subject.reaches && v.limits.torque_Nm > 0.0;
  const double limit = torque ? v.limits.torque_Nm : v.limits.force_N;
  std::string out = fmt::format(
      "set title \"{}{}\" noenhanced textcolor rgb '{}'\n"
      "set ylabel '{}'\nset xrange [0:{}]\nset yrange [{}:{}]\nunset arrow\nL = {}\n",
      v.subject.name, v.passed() ? "" : "  FAILED", v.passed() ? "#222222" : "#b00020",
      torque ? "N m" : "N", v.subject.duration_s, -1.6 * limit, 1.6 * limit, limit);
  if (has_cause(v.subject))
    out += fmt::format(
        "set arrow 1 from {0},graph 0 to {0},graph 1 nohead lc rgb '#b00020' dt 3 lw 1.5\n",
        kCause_s);
  const char* column = torque ? "6" : "3";
  // Limit, commanded (grey), let through (blue, wide), written (black): equal ones lie on each
  // other.
  out += fmt::format(
      "plot L with lines lc rgb '#b00020' dt 2 notitle, -L with lines lc rgb '#b00020' dt 2 "
      "notitle, \\\n"
      "  'trace_{0}.csv' using 2:{1} with lines lc rgb '#999999' lw 1 notitle, \\\n"
      "  'trace_{0}.csv' using 2:{2} with lines lc rgb '#56B4E9' lw 4 notitle, \\\n"
      "  'trace_{0}.csv' using 2:{3} with lines lc rgb '#000000' lw 1 notitle\n",
      v.subject.name, column, torque ? "7" : "4", torque ? "8" : "5");
  return out;
}

/// Of up to kPanels cases from `first` on.
report::Picture curves(const LimitsReport& report, std::size_t first) {
  const std::size_t panels = std::min(kPanels, report.cases.size() - first);
  const std::size_t rows = (panels + kColumns - 1) / kColumns;
  std::string script = fmt::format(
      "set multiplot layout {},{}\nset xlabel 's' offset 0,0.7\n"
      "set samples 2\nset tmargin 1.6\nset title offset 0,-0.6\n",
      rows, kColumns);
  for (std::size_t i = first; i < first + panels; ++i) script += panel(report.cases[i]);
  return {.name = first == 0 ? "curves" : fmt::format("curves_{}", first / kPanels + 1),
          .width_px = kWidth_px,
          .height_px = kHead_px + static_cast<int>(rows) * kPanelHeight_px,
          .script = script + "unset multiplot\n"};
}

report::Picture wall_picture(const WallVerdict& wall) {
  std::string script = R"gp(
set logscale x
set xlabel "stiffness of the wall, N/m"
set ylabel "swing of the tool after 4 s, mm"
set key top left
set yrange [0:*]
)gp";
  script += fmt::format("set xrange [{}:{}]\n", 0.9 * wall.points.front().stiffness_N_per_m,
                        1.1 * wall.points.back().stiffness_N_per_m);
  if (wall.bounded_without_N_per_m > 0.0)
    script += fmt::format(
        "set arrow 1 from {0},graph 0 to {0},graph 1 nohead lc rgb '#D55E00' dt 2 lw 1.5\n",
        wall.bounded_without_N_per_m);
  return {.name = "wall", .width_px = kWidth_px, .height_px = 380, .script = script + R"gp(
plot 'wall.csv' using 2:($4*1e3) with linespoints pt 7 lc 2 lw 2 title "without the passivity stage", \
     'wall.csv' using 2:($8*1e3) with linespoints pt 5 lc 1 lw 2 title "with it"
)gp"};
}

}  // namespace

Result<std::vector<std::string>> draw_curves(const LimitsReport& report,
                                             const std::string& directory) {
  std::vector<report::Picture> pictures;
  for (std::size_t first = 0; first < report.cases.size(); first += kPanels)
    pictures.push_back(curves(report, first));
  if (report.wall) pictures.push_back(wall_picture(*report.wall));
  std::vector<std::string> files;
  for (const report::Picture& picture : pictures) {
    const auto drawn = draw(picture, directory);
    if (!drawn) return drawn.error();
    files.insert(files.end(), drawn->begin(), drawn->end());
  }
  return files;
}

}  // namespace tact::tools::limits
