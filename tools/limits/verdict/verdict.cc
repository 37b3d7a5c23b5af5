// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/verdict/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tact::tools::limits {
namespace {

using firmware::gate::kStageCount;
using firmware::gate::kStageName;

constexpr double kRounding_ratio = model::LimitWitness::kRounding_ratio;
constexpr double kMinTorque_ratio = 0.45;  // of the torque limit, where a torque must go
constexpr double kMinGrip_ratio = 0.999;   // of the limit on the fingers, where it is the case

bool is_outside_or_too_fast(const TickRow& row, const model::Limits& limits) {
  const Vec3& p = row.tool.position_m;
  return std::hypot(p.y, p.z) > limits.workspace_radius_m ||
         std::abs(p.x) > limits.workspace_half_length_m ||
         norm(row.tool.velocity_mps) > limits.speed_mps;
}

bool is_cause(const TickRow& row, const model::Limits& limits) {
  return row.t_s >= 0.0 &&
         (row.cause || !is_finite(row.commanded_N) || is_outside_or_too_fast(row, limits));
}

bool is_zero(const TickRow& row) {
  return row.written_N == Vec3{} && row.written_Nm == Vec3{} && row.written_grip_N == 0.0;
}

/// From the cause to the first zero behind which no force or torque comes while the cause lasts.
std::optional<double> time_to_zero_s(const std::vector<TickRow>& rows,
                                     const model::Limits& limits) {
  std::optional<double> since_s, zero_s;
  bool lasts = false;
  for (const TickRow& row : rows) {
    const bool cause = is_cause(row, limits);
    if (!since_s) {
      if (!cause) continue;
      since_s = row.t_s;
      lasts = true;
    }
    // A cause that has gone may let the force come back: that is no late force.
    lasts = lasts && cause;
    if (is_zero(row) && !zero_s) zero_s = row.t_s - *since_s;
    // Zero for a tick in between is not zero for good.
    if (!is_zero(row) && lasts) zero_s.reset();
  }
  return zero_s;
}

struct Checks {
  std::vector<Check> list;

  void add(bool holds, const char* good, const char* broken) { add(holds, holds ? good : broken); }
  void add(bool holds, std::string message) { list.push_back({std::move(message), holds}); }
};

void check_silence(Checks& checks, const std::vector<TickRow>& rows) {
  const auto all = [&](auto holds) { return std::all_of(rows.begin(), rows.end(), holds); };
  checks.add(
      all([](const TickRow& r) { return is_finite(r.written_N) && is_finite(r.written_Nm); }),
      "every force written is a number");
  checks.add(all([](const TickRow& r) {
               return r.written_N == r.gated_N && r.written_Nm == r.gated_Nm &&
                      r.written_grip_N == r.gated_grip_N;
             }),
             "the device was handed what the gate let through, bit for bit");
  checks.add(all([&](const TickRow& r) { return r.armed || is_zero(r); }),
             "no force while it was not armed", "a force while it was not armed");
  bool faulted = false;
  checks.add(all([&](const TickRow& r) {
               faulted = faulted || latches(r.fault);
               return !faulted || is_zero(r);
             }),
             "no force from a latched fault on", "a force from a latched fault on");
}

void check_expected(Checks& checks, const CaseVerdict& v) {
  const Expected& e = v.subject.expected;
  const bool acted = (v.acted >> static_cast<unsigned>(e.stage) & 1u) != 0;
  checks.add(acted, fmt::format("the stage {} {}", kStageName[static_cast<std::size_t>(e.stage)],
                                acted ? "acted" : "did not act"));
  checks.add(v.fault == e.fault,
             e.fault == Fault::kNone
                 ? fmt::format(
                       "no fault latched{}",
                       v.fault == e.fault ? "" : fmt::format(": {}", model::describe(v.fault).name))
                 : fmt::format("the fault \"{}\" latched{}", model::describe(e.fault).name,
                               v.fault == e.fault
                                   ? ""
                                   : fmt::format(", not \"{}\"", model::describe(v.fault).name)));
  if (e.least_peak_ratio > 0.0)
    checks.add(v.worst.force_N >= e.least_peak_ratio * v.limits.force_N,
               fmt::format("the test had force: {:.4g} N, at least {:.4g} N asked", v.worst.force_N,
                           e.least_peak_ratio * v.limits.force_N));
  if (v.subject.grip == Grip::kJaws)
    checks.add(v.worst.grip_N >= kMinGrip_ratio * v.limits.grip_force_N && v.worst.grip_N > 0.0,
               fmt::format("the test had force on the fingers: {:.4g} N, at least {:.4g} N asked",
                           v.worst.grip_N, kMinGrip_ratio * v.limits.grip_force_N));
  // Cases that end in zero must have had a torque to lose, where they are on a lever.
  if (!e.zero_within_s) return;
  const double least_Nm = kMinTorque_ratio * v.limits.torque_Nm;
  if (v.subject.grip == Grip::kLever)
    checks.add(v.worst.torque_Nm >= least_Nm,
               fmt::format("the test had torque: {:.4g} N m, at least {:.4g} N m asked",
                           v.worst.torque_Nm, least_Nm));
  checks.add(v.worst.zero_s && *v.worst.zero_s <= *e.zero_within_s,
             v.worst.zero_s ? fmt::format("zero {:.4g} ms after the cause, allowed {:.4g} ms",
                                          1e3 * *v.worst.zero_s, 1e3 * *e.zero_within_s)
                            : std::string("force or torque never came to zero for good"));
}

}  // namespace

std::array<BoundCheck, kBoundCount> bounds_of(const Extremes& worst, const model::Limits& limits,
                                              double period_s) {
  const model::Limits& l = limits;
  const double step_N = l.slew_N_per_s * period_s;
  // The slew of the force in proportion; continuous to peak as the force, and never above the peak.
  const double step_Nm = l.force_N > 0.0 ? step_N * l.torque_Nm / l.force_N : 0.0;
  const double continuous_Nm =
      l.force_N > 0.0 ? l.torque_Nm * std::min(l.continuous_force_N / l.force_N, 1.0) : l.torque_Nm;
  const auto rounded = [](const char* what, const char* unit, double largest, double limit) {
    return BoundCheck{what, unit, largest, limit, largest <= limit * kRounding_ratio};
  };
  return {{{"largest force", "N", worst.force_N, l.force_N, worst.force_N <= l.force_N},
           {"largest torque", "N m", worst.torque_Nm, l.torque_Nm, worst.torque_Nm <= l.torque_Nm},
           rounded("largest change in a tick", "N", worst.step_N, step_N),
           rounded("largest change of torque in a tick", "N m", worst.step_Nm, step_Nm),
           rounded("largest power", "W", worst.power_W, l.power_W),
           {"energy given", "J", worst.given_energy_J, l.energy_J, worst.overdrawn_J <= 0.0},
           {"largest RMS", "N", worst.rms_N, std::min(l.continuous_force_N, l.force_N),
            worst.rms_N <= l.continuous_force_N * kRounding_ratio},
           rounded("largest RMS of the torque", "N m", worst.rms_Nm, continuous_Nm),
           rounded("largest force on the fingers", "N", worst.grip_N, l.grip_force_N)}};
}

std::vector<Check> check_bounds(const Extremes& worst, const model::Limits& limits,
                                double period_s) {
  std::vector<Check> checks;
  for (const BoundCheck& b : bounds_of(worst, limits, period_s))
    checks.push_back(
        {fmt::format("{} {:.4g} {}, limit {:.4g} {}", b.what, b.largest, b.unit, b.limit, b.unit),
         b.holds});
  // What comes back with time is part of the budget.
  checks[static_cast<std::size_t>(Bound::kEnergy)].message =
      fmt::format("energy given {:.4g} J, budget {:.4g} J and {:.4g} W", worst.given_energy_J,
                  limits.energy_J, limits.recovery_W);
  return checks;
}

bool all_hold(const std::vector<Check>& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.holds; });
}

std::string CaseVerdict::acted_text() const {
  std::string words;
  for (std::size_t i = 0; i < kStageCount; ++i)
    if ((acted >> i & 1u) != 0)
      words += fmt::format("{}{}", words.empty() ? "" : ", ", kStageName[i]);
  return words.empty() ? "none" : words;
}

Extremes extremes_of(const std::vector<TickRow>& rows, const model::Limits& limits,
                     double period_s) {
  model::LimitWitness witness(limits, period_s);
  Extremes worst;
  for (const TickRow& row : rows) {
    const char* broken = witness.check({.written = {row.written_N, row.written_Nm},
                                        .written_grip_N = row.written_grip_N,
                                        .tool = row.tool,
                                        .fresh = row.fresh,
                                        .armed = row.armed,
                                        .faulted = latches(row.fault),
                                        .skipped_periods = row.skipped_periods});
    if (broken != nullptr && worst.broken.empty())
      worst.broken = fmt::format("{}, {:.4g} s", broken, row.t_s);
    if (is_finite(row.commanded_N))
      worst.commanded_N = std::max(worst.commanded_N, norm(row.commanded_N));
  }
  static_cast<model::LimitExtremes&>(worst) = witness.worst();
  worst.zero_s = time_to_zero_s(rows, limits);
  return worst;
}

CaseVerdict check_rows(const Case& c, const std::vector<TickRow>& rows, const model::Limits& limits,
                       double period_s) {
  CaseVerdict v{
      .subject = c, .limits = limits, .worst = extremes_of(rows, limits, period_s), .checks = {}};
  v.overshoot_N = std::max(v.worst.force_N - limits.force_N, 0.0);
  for (const TickRow& row : rows) {
    if (row.t_s >= 0.0) v.acted |= row.acted;
    // The first one is the cause; what comes after it may follow from it.
    if (v.fault == Fault::kNone) v.fault = row.fault;
  }
  Checks checks;
  checks.add(!rows.empty() && rows.back().t_s >= 0.0, "it armed, and the case began",
             "it did not arm, or the case did not begin");
  for (Check& bound : check_bounds(v.worst, limits, period_s))
    checks.list.push_back(std::move(bound));
  const std::string& broken = v.worst.broken;
  checks.add(broken.empty(), broken.empty() ? "every tick kept every limit in full"
                                            : "a limit was broken: " + broken);
  check_silence(checks, rows);
  check_expected(checks, v);
  v.checks = std::move(checks.list);
  return v;
}

CaseVerdict check_case(const CaseRun& run) {
  CaseVerdict v = check_rows(run.subject(), run.rows(), run.limits(), run.period_s());
  if (run.refused() == Fault::kNone) return v;
  v.fault = run.refused();
  v.checks.push_back(
      {fmt::format("it could not be armed: {}", model::describe(v.fault).cause), false});
  return v;
}

}  // namespace tact::tools::limits
