// SPDX-License-Identifier: Apache-2.0
// One panel a case: what was commanded, what the gate let through, what the device was handed, and
// the limit as two lines. Gnuplot reads the traces beside the plot.
#include <fmt/format.h>

#include <algorithm>

#include "tools/limits/report/report.h"
#include "tools/limits/report/scripts.h"
#include "tools/report/plot.h"

namespace tact::tools::limits {
namespace {

using model::Result;

// Twelve panels fill an A4 page, and their words are still read there.
constexpr std::size_t kColumns = 2, kPanels = 12;
constexpr int kPanelHeight_px = 190, kWidth_px = 900, kHead_px = 30;

/// Has it a moment to mark?
bool has_cause(const Case& c) {
  return c.injected != InjectedFault::kNone || c.shape == Shape::kNan ||
         c.shape == Shape::kInfinity;
}

/// Of up to kPanels cases from `first` on.
report::Plot curves(const LimitsReport& report, std::size_t first) {
  const std::size_t panels = std::min(kPanels, report.cases.size() - first);
  const std::size_t rows = (panels + kColumns - 1) / kColumns;
  std::vector<std::string> cases, limits, seconds, columns, failed, causes;
  for (std::size_t i = first; i < first + panels; ++i) {
    const CaseVerdict& v = report.cases[i].verdict;
    // of torque and force the one that the case drives to its limit
    const bool torque =
        v.subject.grip == Grip::kLever && v.subject.reaches && v.limits.torque_Nm > 0.0;
    cases.emplace_back(v.subject.name);
    limits.push_back(fmt::format("{}", torque ? v.limits.torque_Nm : v.limits.force_N));
    seconds.push_back(fmt::format("{}", v.subject.duration_s));
    columns.emplace_back(torque ? "6" : "3");
    failed.emplace_back(v.passed() ? "0" : "1");
    causes.push_back(has_cause(v.subject) ? fmt::format("{}", kCause_s) : "none");
  }
  return {.name = first == 0 ? "curves" : fmt::format("curves_{}", first / kPanels + 1),
          .width_px = kWidth_px,
          .height_px = kHead_px + static_cast<int>(rows) * kPanelHeight_px,
          .script = kCurvesScript,
          .variables = {{"rows", static_cast<double>(rows)},
                        {"cases", cases},
                        {"limits", limits},
                        {"seconds", seconds},
                        {"columns", columns},
                        {"failed", failed},
                        {"causes", causes}}};
}

report::Plot wall_plot(const WallVerdict& wall) {
  return {.name = "wall",
          .width_px = kWidth_px,
          .height_px = 380,
          .script = kWallScript,
          .variables = {{"softest", wall.points.front().stiffness_N_per_m},
                        {"stiffest", wall.points.back().stiffness_N_per_m},
                        {"bounded_N_per_m", wall.bounded_without_N_per_m}}};
}

}  // namespace

Result<std::vector<std::string>> draw_curves(const LimitsReport& report,
                                             const std::string& directory) {
  std::vector<report::Plot> plots;
  for (std::size_t first = 0; first < report.cases.size(); first += kPanels)
    plots.push_back(curves(report, first));
  if (report.wall) plots.push_back(wall_plot(*report.wall));
  std::vector<std::string> files;
  for (const report::Plot& plot : plots) {
    const auto drawn = draw(plot, directory);
    if (!drawn) return drawn.error();
    files.insert(files.end(), drawn->begin(), drawn->end());
  }
  return files;
}

}  // namespace tact::tools::limits
