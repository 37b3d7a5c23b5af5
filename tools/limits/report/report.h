// SPDX-License-Identifier: Apache-2.0
// report.h - what a test of the limits leaves behind: JSON for machines and CSV of every tick. Of
// these limits_page.py makes the curves, and one page that a safety officer can read.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware/pc/environment.h"
#include "model/result.h"
#include "tools/limits/evidence/evidence.h"
#include "tools/limits/verdict/wall.h"
#include "tools/report/table.h"

namespace tact::tools::limits {

struct CaseResult {
  CaseVerdict verdict;
  std::vector<TickRow> rows;
};

/// A case of the whole plan that was not played.
struct LeftOut {
  std::string name, why;
};

struct LimitsReport {
  std::string command, started;  // as typed; UTC
  std::string scene_name, scene_path, device_name;
  bool simulated = true;
  model::Limits scene_limits{};  // as the scene has them
  model::Limits limits{};        // tested: of scene and device, on a real device also of the PC
  model::Limits pc_limits{};     // of a tactd on this PC, which may allow a quarter of the force
  double period_s = 0.001;
  double force_share = 1.0;
  bool hard_real_time = true;  // asked of the PC; simulated time needs none
  bool call_filter = false;    // over the loop's system calls, on a real device
  firmware::pc::Environment environment{};
  std::vector<CaseResult> cases;
  std::optional<WallVerdict> wall;
  Evidence evidence{};
  std::vector<LeftOut> not_run;  // the rest of the plan, so that it is not taken for tested

  bool passed() const;
  std::size_t played() const { return cases.size() + (wall ? 1 : 0); }
  /// "PASS", "PASS of 2 of 26 cases", "FAIL"; the page says SIMULATED before it
  std::string result_text() const;
  /// Names of the cases that were left out, by why.
  std::vector<std::pair<std::string, std::string>> left_out_by_why() const;
};

/// A row of cases.csv, and the numbers of limits.json.
report::Row case_row(const CaseVerdict& v);
nlohmann::json to_json(const LimitsReport& report);
/// Part of it: the hazards, their requirements, what shows these, and what this run has shown.
nlohmann::json hazards_json(const LimitsReport& report);
/// A line for each case, on a terminal.
std::string to_text(const LimitsReport& report);
/// limits.json, cases.csv, a trace_NAME.csv for each case, wall.csv.
std::optional<model::Error> write_report(const LimitsReport& report, const std::string& directory);

}  // namespace tact::tools::limits
