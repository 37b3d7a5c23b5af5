// SPDX-License-Identifier: Apache-2.0
// verdict.h - did the force keep its limits (model/limit_witness.h)? Evaluated from the record of a
// case alone: nothing here asks the gate what it thinks of itself. F is what the device was handed
// last; it is zero exactly while not armed, and from a latched fault on.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "model/limit_witness.h"
#include "tools/limits/cases/case_run.h"

namespace tact::tools::limits {

/// One thing that had to hold.
struct Check {
  std::string message;  // with the numbers
  bool holds = false;
};
bool all_hold(const std::vector<Check>& checks);

/// The worst of a record, for the report and for the checks.
struct Extremes : model::LimitExtremes {
  double commanded_N = 0.0;
  std::string broken;  // the first limit of the witness that a tick broke, and when; empty: none
  // From the cause to zero force and torque, which stay zero while it lasts; none: no cause, or
  // never zero.
  std::optional<double> zero_s{};
};

struct CaseVerdict {
  Case subject{};
  model::Limits limits{};
  Extremes worst;
  double overshoot_N = 0.0;  // of |F| above force_N
  std::uint32_t acted = 0;   // stages, one bit each
  Fault fault = Fault::kNone;
  std::vector<Check> checks;

  bool passed() const { return all_hold(checks); }
  /// "slew, magnitude"
  std::string acted_text() const;
};

Extremes extremes_of(const std::vector<TickRow>& rows, const model::Limits& limits,
                     double period_s);
/// A limit and the largest value that came near it.
struct BoundCheck {
  const char* what;
  const char* unit;
  double largest = 0.0, limit = 0.0;
  bool holds = false;
};
/// In the order of Bound.
std::array<BoundCheck, kBoundCount> bounds_of(const Extremes& worst, const model::Limits& limits,
                                              double period_s);
/// The bounds above as messages.
std::vector<Check> check_bounds(const Extremes& worst, const model::Limits& limits,
                                double period_s);
CaseVerdict check_rows(const Case& c, const std::vector<TickRow>& rows, const model::Limits& limits,
                       double period_s);
CaseVerdict check_case(const CaseRun& run);

}  // namespace tact::tools::limits
