// SPDX-License-Identifier: Apache-2.0
// verdict.h - did the force keep its limits? Judged from the record of a case alone, with accounts
// of its own: nothing here asks the gate what it thinks of itself.
//
//     |F| <= force_N     |T| <= torque_Nm     |dF| <= slew_N_per_s T     F . v + T . w <= power_W
//     sum of F_(k-1) . (x_k - x_(k-1)) <= energy_J + recovery_W t        RMS <= continuous_force_N
//     RMS of T <= torque_Nm continuous_force_N / force_N
//     F = 0 exactly while not armed, and from a latched fault on
//
// F is what the device was handed last. Of missed samples the mean force counts along the way that
// the next one shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/limits/cases/case_run.h"

namespace tact::tools::limits {

/// One thing that had to hold.
struct Check {
  std::string sentence;  // with the numbers
  bool holds = false;
};

/// The worst of a record, for the report and for the checks.
struct Extremes {
  double force_N = 0.0, commanded_N = 0.0, torque_Nm = 0.0, power_W = 0.0;
  double step_N = 0.0, step_Nm = 0.0;  // for each period that passed since the write before
  double given_J = 0.0;                // largest since arming
  double overdrawn_J = 0.0;            // above budget and recovery; 0: never
  double rms_N = 0.0, rms_Nm = 0.0;
  double grip_N = 0.0;  // on the fingers
  // From the cause to zero force and torque, which stay zero while it stands; none: no cause, or
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

  bool passed() const;
  /// "slew, magnitude"
  std::string acted_words() const;
};

/// That the tick gives to the hand, by force and by torque.
double power_W(const TickRow& row);
Extremes extremes_of(const std::vector<TickRow>& rows, const model::Limits& limits,
                     double period_s);
/// Largest change in a tick: the slew of the force, in proportion.
double torque_step_Nm(const model::Limits& limits, double period_s);
/// Largest RMS of the torque: continuous to peak as the force, and never more than its peak.
double continuous_torque_Nm(const model::Limits& limits);
/// The bounds above, each with its largest value.
std::vector<Check> check_bounds(const Extremes& worst, const model::Limits& limits,
                                double period_s);
CaseVerdict judge_rows(const Case& c, const std::vector<TickRow>& rows, const model::Limits& limits,
                       double period_s);
CaseVerdict judge_case(const CaseRun& run);

}  // namespace tact::tools::limits
