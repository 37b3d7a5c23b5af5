// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/report/limit_rows.h"

#include <algorithm>
#include <array>

namespace tact::tools::limits {
namespace {

using Values = std::array<double, kBoundCount>;

Values limits_in_order(const model::Limits& l, double period_s) {
  return {l.force_N,
          l.torque_Nm,
          l.slew_N_per_s * period_s,
          torque_step_Nm(l, period_s),
          l.power_W,
          l.energy_J,
          std::min(l.continuous_force_N, l.force_N),
          continuous_torque_Nm(l),
          l.grip_force_N};
}

Values largest_in_order(const Extremes& w) {
  return {w.force_N, w.torque_Nm, w.step_N, w.step_Nm, w.power_W,
          w.given_J, w.rms_N,     w.rms_Nm, w.grip_N};
}

/// A case drives to a limit when its stage had something to do.
bool has_reached(const CaseVerdict& v, std::size_t bound) {
  const auto stage = static_cast<unsigned>(v.subject.expected.stage);
  return v.subject.reaches && static_cast<std::size_t>(*v.subject.reaches) == bound &&
         (v.acted >> stage & 1u) != 0;
}

void add_case(LimitRow& row, const CaseVerdict& v, bool reached, const TighterLimit& own) {
  const bool is_tighter = own.limit < row.limit;
  // A case with a tighter limit says nothing of how near the scene's own was come.
  if (!is_tighter) row.largest = std::max(row.largest, own.largest);
  if (reached) {
    row.reached_by.emplace_back(v.subject.name);
    if (is_tighter) row.tighter.push_back(own);
    row.kept = std::max(row.kept, is_tighter ? Kept::kPassTighter : Kept::kPass);
  }
  // Last, so that no pass of another case hides it.
  if (!own.holds) row.kept = Kept::kFail;
}

}  // namespace

const char* kept_text(Kept kept) {
  switch (kept) {
    case Kept::kNotReached:
      return "not reached";
    case Kept::kPassTighter:
      return "pass at a tighter limit";
    case Kept::kPass:
      return "pass";
    case Kept::kFail:
      return "FAIL";
  }
  return "FAIL";
}

std::vector<LimitRow> limit_rows(const LimitsReport& report) {
  std::vector<LimitRow> rows{{"Force", "limits.force_N", "N"},
                             {"Torque", "limits.torque_Nm", "N m"},
                             {"Change of the force in one tick", "limits.slew_N_per_s", "N"},
                             {"Change of the torque in one tick", "limits.slew_N_per_s", "N m"},
                             {"Power given to the hand", "limits.power_W", "W"},
                             {"Energy given to the hand since arming", "limits.energy_J", "J"},
                             {"RMS of the force", "limits.continuous_force_N", "N"},
                             {"RMS of the torque", "limits.continuous_force_N", "N m"},
                             {"Force on the fingers", "limits.grip_force_N", "N"}};
  const Values limits = limits_in_order(report.limits, report.period_s);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].limit = limits[i];
  for (const CaseResult& result : report.cases) {
    const CaseVerdict& v = result.verdict;
    const Values own = limits_in_order(v.limits, report.period_s);
    const Values largest = largest_in_order(v.worst);
    // In the order of Bound, as the rows are.
    const std::vector<Check> bounds = check_bounds(v.worst, v.limits, report.period_s);
    for (std::size_t i = 0; i < rows.size(); ++i)
      add_case(rows[i], v, has_reached(v, i),
               {.case_name = v.subject.name,
                .limit = own[i],
                .largest = largest[i],
                .holds = bounds[i].holds});
  }
  return rows;
}

}  // namespace tact::tools::limits
