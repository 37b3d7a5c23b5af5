// SPDX-License-Identifier: Apache-2.0
#include "model/law/series_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/law/law_bounds.h"

namespace tact::model::law {
namespace {

// Bisection alone needs 60 to reach the last bit of a double; Newton ends far earlier.
constexpr int kMaxIterations = 100;

}  // namespace

SeriesLaw::SeriesLaw(const Law& law, double compliance_m_per_N, const Law& shape)
    : law_(&law), shape_(&shape), compliance_m_per_N_(compliance_m_per_N) {
  const LawRange own = law.range();
  // A compliance above zero deepens the pair, but no place saturates
  // deeper than the law alone; one below zero shortens it.
  range_ = {.pull_m = std::max(own.pull_m, depth_of(own.pull_m)),
            .press_m = std::min(own.press_m, depth_of(own.press_m))};
}

// SL-1  d = e + r F(e)
double SeriesLaw::depth_of(double indentation_m) const RT_SAFE {
  return indentation_m + compliance_m_per_N_ * law_->respond(indentation_m).force_N;
}

/// The indentation whose depth this is; the depth grows with it.
double SeriesLaw::indentation_at(double depth_m) const RT_SAFE {
  // 0 is an end of both brackets, which a Newton step may
  // not reach: it would be halved towards for ever.
  if (depth_m == 0.0) return 0.0;
  double low_m = depth_m > 0.0 ? 0.0 : law_->range().pull_m;
  double high_m = depth_m > 0.0 ? law_->range().press_m : 0.0;
  double indentation_m = std::clamp(depth_m, low_m, high_m);
  for (int i = 0; i < kMaxIterations; ++i) {
    const LawResponse at = law_->respond(indentation_m);
    const double miss_m = indentation_m + compliance_m_per_N_ * at.force_N - depth_m;
    (miss_m < 0.0 ? low_m : high_m) = indentation_m;
    double next_m = indentation_m - miss_m / (1.0 + compliance_m_per_N_ * at.stiffness_N_per_m);
    if (!(next_m > low_m && next_m < high_m)) next_m = 0.5 * (low_m + high_m);
    // Two roundings of a double: nothing better can be reached.
    const bool done = std::abs(next_m - indentation_m) <= 4e-16 * std::abs(next_m);
    indentation_m = next_m;
    if (done) break;
  }
  return indentation_m;
}

LawResponse SeriesLaw::respond(double depth_m) const RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = LawStatus::kInvalid};
  if (depth_m < 0.0 && range_.pull_m == 0.0) return {.status = LawStatus::kNoContact};
  const double inside_m = std::clamp(depth_m, range_.pull_m, range_.press_m);
  LawResponse out = law_->respond(indentation_at(inside_m));
  // SL-2, SL-3
  out.energy_J += 0.5 * compliance_m_per_N_ * out.force_N * out.force_N;
  out.stiffness_N_per_m /= 1.0 + compliance_m_per_N_ * out.stiffness_N_per_m;
  return beyond_limit(out, inside_m, depth_m);
}

// SL-4. A compliance below zero would raise the damping above the law's own: it counts as none.
double SeriesLaw::damping_Ns_per_m(double depth_m) const RT_SAFE {
  if (!(depth_m > 0.0) || !std::isfinite(depth_m)) return 0.0;
  const double indentation_m = indentation_at(std::min(depth_m, range_.press_m));
  const double compliance_m_per_N = std::max(compliance_m_per_N_, 0.0);
  const double share =
      1.0 / (1.0 + compliance_m_per_N * law_->respond(indentation_m).stiffness_N_per_m);
  return law_->damping_Ns_per_m(indentation_m) * share * share;
}

Result<SeriesLaw> make_series_law(const Law& law, double compliance_m_per_N, const Law& shape) {
  const double most_N_per_m = stiffest_N_per_m(law, law.range().pull_m, law.range().press_m);
  if (!(1.0 + compliance_m_per_N * most_N_per_m > 0.0) || !std::isfinite(compliance_m_per_N))
    return Error{
        fmt::format("law in series: a compliance of {:g} m/N with a law of up to {:g} N/m; "
                    "allowed: finite and above "
                    "-1 / stiffness",
                    compliance_m_per_N, most_N_per_m)};
  return SeriesLaw(law, compliance_m_per_N, shape);
}

}  // namespace tact::model::law
