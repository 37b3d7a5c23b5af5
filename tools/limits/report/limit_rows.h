// SPDX-License-Identifier: Apache-2.0
// limit_rows.h - the limits of a report: what came nearest to each, and was it reached at all?
#pragma once

#include <string>
#include <vector>

#include "tools/limits/report/report.h"

namespace tact::tools::limits {

enum class Kept : std::uint8_t {
  kNotReached,   // no case that is there to reach it ran, or its stage had nothing to do
  kPassTighter,  // reached, but only where a case had made it tighter
  kPass,
  kFail,  // in any case, tightened or not
};
/// "not reached", "pass at a tighter limit", "pass", "FAIL"
const char* kept_text(Kept kept);

/// The limit of a case that made it tighter.
struct TighterLimit {
  const char* case_name;
  double limit = 0.0, largest = 0.0;
  bool holds = false;
};

/// One limit, and what came nearest to it in all cases that left it as it is.
struct LimitRow {
  const char* name;  // for a reader
  const char* key;   // of the scene
  const char* unit;
  double limit = 0.0, largest = 0.0;
  struct {
    double limit = 0.0;
  } scene{}, pc{};  // as written; of a tactd on this PC
  Kept kept = Kept::kNotReached;
  std::vector<std::string> reached_by{};  // names of cases
  std::vector<TighterLimit> tighter{};
};
std::vector<LimitRow> limit_rows(const LimitsReport& report);

}  // namespace tact::tools::limits
