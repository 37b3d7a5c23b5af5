// SPDX-License-Identifier: Apache-2.0
#include "model/law/laws_in_series.h"

#include <algorithm>
#include <cmath>

namespace tact::model::law {
namespace {

constexpr int kHalvings = 60;  // of a range, to the last bit of a double
constexpr int kSamples = 1000;

/// Where |F| reaches that force, towards the end of a range; the force grows with the depth.
double depth_of_m(const Law& law, double force_N, double end_m) {
  double low_m = 0.0, high_m = end_m;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    (std::abs(law.respond(middle_m).force_N) < force_N ? low_m : high_m) = middle_m;
  }
  return high_m;
}

/// The end of the pair: the end of the weaker of the two, and the other at that force.
double end_of_m(const Law& tip, double tip_end_m, const Law& organ, double organ_end_m) {
  const double tip_N = std::abs(tip.respond(tip_end_m).force_N),
               organ_N = std::abs(organ.respond(organ_end_m).force_N);
  if (tip_N <= organ_N) return tip_end_m + depth_of_m(organ, tip_N, organ_end_m);
  return depth_of_m(tip, organ_N, tip_end_m) + organ_end_m;
}

bool falls(const Law& law) {
  const LawRange range = law.range();
  double before_N = law.respond(range.pull_m).force_N;
  for (int i = 1; i <= kSamples; ++i) {
    const double share = static_cast<double>(i) / kSamples;
    const double at_N = law.respond(range.pull_m + share * (range.press_m - range.pull_m)).force_N;
    if (!(at_N >= before_N)) return true;
    before_N = at_N;
  }
  return false;
}

/// SL-6; two springs without stiffness have none together.
double in_series_N_per_m(double a_N_per_m, double b_N_per_m) RT_SAFE {
  const double sum_N_per_m = a_N_per_m + b_N_per_m;
  return sum_N_per_m > 0.0 ? a_N_per_m * b_N_per_m / sum_N_per_m : 0.0;
}

}  // namespace

LawsInSeries::LawsInSeries(const Law& tip, const Law& organ) : tip_(&tip), organ_(&organ) {
  const LawRange a = tip.range(), b = organ.range();
  range_.press_m = end_of_m(tip, a.press_m, organ, b.press_m);
  if (a.pull_m < 0.0 && b.pull_m < 0.0) range_.pull_m = end_of_m(tip, a.pull_m, organ, b.pull_m);
}

/// SL-5 by halving: what the tip takes of a depth inside the range.
double LawsInSeries::tip_depth_m(double depth_m) const RT_SAFE {
  const LawRange tip = tip_->range(), organ = organ_->range();
  // Neither leaves its own range, so both forces are those of their laws.
  double low_m = std::max({tip.pull_m, std::min(depth_m, 0.0), depth_m - organ.press_m});
  double high_m = std::min({tip.press_m, std::max(depth_m, 0.0), depth_m - organ.pull_m});
  for (int i = 0; i < kHalvings && low_m < high_m; ++i) {
    const double e_m = 0.5 * (low_m + high_m);
    const bool is_shallow = tip_->respond(e_m).force_N < organ_->respond(depth_m - e_m).force_N;
    (is_shallow ? low_m : high_m) = e_m;
  }
  return high_m;
}

LawResponse LawsInSeries::respond(double depth_m) const RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = LawStatus::kInvalid};
  if (depth_m < 0.0 && range_.pull_m == 0.0) return {.status = LawStatus::kNoContact};
  const double inside_m = std::clamp(depth_m, range_.pull_m, range_.press_m);
  const double e_m = tip_depth_m(inside_m);
  const LawResponse tip = tip_->respond(e_m), organ = organ_->respond(inside_m - e_m);
  return beyond_limit(
      {.force_N = organ.force_N,
       .stiffness_N_per_m = in_series_N_per_m(tip.stiffness_N_per_m, organ.stiffness_N_per_m),
       .energy_J = tip.energy_J + organ.energy_J},
      inside_m, depth_m);
}

// SL-7  b = (K / K_tip)^2 b_tip(e) + (K / K_organ)^2 b_organ(y)
double LawsInSeries::damping_Ns_per_m(double depth_m) const RT_SAFE {
  if (!(depth_m > 0.0) || !std::isfinite(depth_m)) return 0.0;
  const double inside_m = std::min(depth_m, range_.press_m);
  const double e_m = tip_depth_m(inside_m), y_m = inside_m - e_m;
  const double tip_N_per_m = tip_->respond(e_m).stiffness_N_per_m,
               organ_N_per_m = organ_->respond(y_m).stiffness_N_per_m;
  const double sum_N_per_m = tip_N_per_m + organ_N_per_m;
  if (!(sum_N_per_m > 0.0)) return 0.0;
  const double tip_share = organ_N_per_m / sum_N_per_m, organ_share = tip_N_per_m / sum_N_per_m;
  return tip_share * tip_share * tip_->damping_Ns_per_m(e_m) +
         organ_share * organ_share * organ_->damping_Ns_per_m(y_m);
}

Result<LawsInSeries> make_laws_in_series(const Law& tip, const Law& organ) {
  for (const Law* law : {&tip, &organ})
    if (falls(*law))
      return Error{"its force falls as its depth grows, so it cannot be in series with a tip"};
  return LawsInSeries(tip, organ);
}

}  // namespace tact::model::law
