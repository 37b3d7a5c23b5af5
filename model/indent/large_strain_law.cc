// SPDX-License-Identifier: Apache-2.0
#include "model/indent/large_strain_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tact::model::indent {
namespace {

// Of the table's end: off the jump of the slope at rest, and of no weight against a knot.
constexpr double kBesideRest = 1e-9;

}  // namespace

law::LawResponse LargeStrainLaw::respond(double depth_m) const RT_SAFE {
  if (!(depth_m > 0.0) || !std::isfinite(depth_m)) return small_->respond(depth_m);
  const double inside_m = std::min(depth_m, press_.end());
  const law::CurvePoint p = press_.at(inside_m);
  return law::beyond_limit({p.value, p.slope, p.integral, law::LawStatus::kOk}, inside_m, depth_m);
}

Result<LargeStrainLaw> make_large_strain_law(const law::Law& small, const ElasticTip& tip,
                                             std::size_t knots) {
  LargeStrainLaw out(small);
  const double end_m = small.range().press_m;
  const auto curve = [&small, &tip, end_m](double depth_m) {
    const double beside_m = std::max(depth_m, kBesideRest * end_m);
    const StrainFactor at = large_strain_factor(tip.poisson_ratio, beside_m / tip.radius_m);
    const law::LawResponse of = small.respond(beside_m);
    return law::CurvePoint{
        .value = at.factor * small.respond(depth_m).force_N,
        .slope = at.factor * of.stiffness_N_per_m + at.slope * of.force_N / tip.radius_m};
  };
  out.press_ = law::HermiteTable(end_m / static_cast<double>(knots - 1), knots, curve);
  // What the loop will read is tried, not the knots alone.
  const std::size_t checks = 8 * knots;
  for (std::size_t i = 1; i <= checks; ++i) {
    const double depth_m = end_m * static_cast<double>(i) / static_cast<double>(checks);
    if (!(out.press_.at(depth_m).slope >= 0.0))
      return Error{fmt::format(
          "at large strain the force falls at a depth of {:g} m; choose parameters whose force "
          "grows faster with depth, or write compliance.large_strain = false",
          depth_m)};
  }
  return out;
}

}  // namespace tact::model::indent
