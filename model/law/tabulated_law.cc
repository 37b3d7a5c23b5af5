// SPDX-License-Identifier: Apache-2.0
#include "model/law/tabulated_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/law/law_bounds.h"

namespace tact::model::law {
namespace {

// Of the table's end: off the jump of the slope at rest, and of no weight against a knot.
constexpr double kBesideRest = 1e-9;
constexpr double kPressShare = 0.95;  // the slope of a snapping chain is infinite at its very limit

/// From rest to a limit, which lies below 0 for pull.
HermiteTable table_to(const Law& law, double end_m, std::size_t knots) {
  return {end_m / static_cast<double>(knots - 1), knots, [&law, end_m](double depth_m) {
            // At rest each side has its own slope: a law may pull softer than it presses.
            const double side_m = depth_m == 0.0 ? kBesideRest * end_m : depth_m;
            return CurvePoint{.value = law.respond(depth_m).force_N,
                              .slope = law.respond(side_m).stiffness_N_per_m};
          }};
}

}  // namespace

LawResponse TabulatedLaw::respond(double depth_m) const RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = LawStatus::kInvalid};
  if (depth_m < 0.0 && !can_pull_) return {.status = LawStatus::kNoContact};
  const HermiteTable& table = depth_m < 0.0 ? pull_ : press_;
  const double end_m = table.end();
  const double inside_m = std::abs(depth_m) > std::abs(end_m) ? end_m : depth_m;
  const CurvePoint p = table.at(inside_m);
  return beyond_limit({p.value, p.slope, p.integral, LawStatus::kOk}, inside_m, depth_m);
}

double TabulatedLaw::damping_Ns_per_m(double depth_m) const RT_SAFE {
  if (damping_Ns_per_m_.empty() || !(depth_m > 0.0) || !std::isfinite(depth_m)) return 0.0;
  const std::size_t last = damping_Ns_per_m_.size() - 1;
  // Linear and not a cubic: damping has no slope to keep, and a cubic could fall below zero.
  const double at = std::min(depth_m / press_.end(), 1.0) * static_cast<double>(last);
  const std::size_t low = std::min(static_cast<std::size_t>(at), last - 1);
  const double low_Ns_per_m = damping_Ns_per_m_[low], high_Ns_per_m = damping_Ns_per_m_[low + 1];
  return low_Ns_per_m + (at - static_cast<double>(low)) * (high_Ns_per_m - low_Ns_per_m);
}

Result<TabulatedLaw> tabulate(const Law& law, std::size_t knots) {
  if (knots < 2 || knots > kMaxKnots)
    return Error{fmt::format("law table: knots must lie between 2 and {}", kMaxKnots)};
  const LawRange range = law.range();
  TabulatedLaw out(law);
  out.press_ = table_to(law, kPressShare * range.press_m, knots);
  out.can_pull_ = range.pull_m < 0.0;
  if (out.can_pull_) out.pull_ = table_to(law, range.pull_m, knots);
  if (most_damping_Ns_per_m(law) > 0.0)
    for (std::size_t k = 0; k < knots; ++k)
      out.damping_Ns_per_m_.push_back(law.damping_Ns_per_m(
          out.press_.end() * static_cast<double>(k) / static_cast<double>(knots - 1)));
  // Knots that rise do not make a cubic between them rise:
  // what the loop will read is tried, not the law.
  const std::size_t checks = 8 * knots;
  double before_N = law.respond(range.pull_m).force_N;
  for (std::size_t i = 1; i <= checks; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(checks);
    const double depth_m = range.pull_m + share * (kPressShare * range.press_m - range.pull_m);
    const double force_N = out.respond(depth_m).force_N;
    if (!(force_N >= before_N))
      return Error{fmt::format(
          "law table: the force falls at a depth of {:g} m; choose parameters whose force grows "
          "with depth",
          depth_m)};
    before_N = force_N;
  }
  return out;
}

}  // namespace tact::model::law
