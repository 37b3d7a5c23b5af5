// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/report/limit_rows.h"

#include <algorithm>

namespace tact::tools::limits {
namespace {

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
  constexpr const char* kWords[] = {"not reached", "pass at a tighter limit", "pass", "FAIL"};
  return kWords[static_cast<std::size_t>(kept)];
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
  const auto limits = bounds_of({}, report.limits, report.period_s);
  const auto scene = bounds_of({}, report.scene_limits, report.period_s);
  const auto pc = bounds_of({}, report.pc_limits, report.period_s);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].limit = limits[i].limit;
    rows[i].scene.limit = scene[i].limit;
    rows[i].pc.limit = pc[i].limit;
  }
  for (const CaseResult& result : report.cases) {
    const CaseVerdict& v = result.verdict;
    const auto bounds = bounds_of(v.worst, v.limits, report.period_s);
    for (std::size_t i = 0; i < rows.size(); ++i)
      add_case(rows[i], v, has_reached(v, i),
               {.case_name = v.subject.name,
                .limit = bounds[i].limit,
                .largest = bounds[i].largest,
                .holds = bounds[i].holds});
  }
  return rows;
}

}  // namespace tact::tools::limits
