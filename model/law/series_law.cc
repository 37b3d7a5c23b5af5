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

/// Where a force that grows with the depth has this value, towards the end of a range.
double depth_of_force_m(const Law& law, double force_N, double end_m) RT_SAFE {
  if (force_N == 0.0) return 0.0;
  double low_m = 0.0, high_m = end_m;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    if (middle_m == low_m || middle_m == high_m) break;
    (std::abs(law.respond(middle_m).force_N) < std::abs(force_N) ? low_m : high_m) = middle_m;
  }
  return high_m;
}

bool falls(const Law& law) {
  constexpr int kSamples = 1000;
  const LawRange range = law.range();
  double before_N = law.respond(range.pull_m).force_N;
  for (int i = 1; i <= kSamples; ++i) {
    const double at_m = range.pull_m + (range.press_m - range.pull_m) * i / kSamples;
    const double at_N = law.respond(at_m).force_N;
    if (!(at_N >= before_N)) return true;
    before_N = at_N;
  }
  return false;
}

}  // namespace

SeriesLaw::SeriesLaw(const Law& law, const Law* organ, double compliance_m_per_N, const Law& shape)
    : law_(&law),
      organ_(organ),
      shape_(&shape),
      compliance_m_per_N_(compliance_m_per_N),
      indentation_(law.range()) {
  const auto shorten = [this](double& end_m, double organ_end_m) {
    const double organ_N = organ_->respond(organ_end_m).force_N;
    if (std::abs(organ_N) < std::abs(law_->respond(end_m).force_N))
      end_m = depth_of_force_m(*law_, organ_N, end_m);
  };
  if (organ_ != nullptr) {
    shorten(indentation_.press_m, organ_->range().press_m);
    shorten(indentation_.pull_m, organ_->range().pull_m);
  }
  range_ = {.pull_m = depth_of(indentation_.pull_m), .press_m = depth_of(indentation_.press_m)};
  // A compliance above zero deepens the pair, but no place of an organ that is linear saturates
  // deeper than the law alone; one below zero shortens it.
  if (organ_ == nullptr)
    range_ = {.pull_m = std::max(indentation_.pull_m, range_.pull_m),
              .press_m = std::min(indentation_.press_m, range_.press_m)};
}

double SeriesLaw::displacement_m(double force_N) const RT_SAFE {
  if (organ_ == nullptr) return compliance_m_per_N_ * force_N;
  const LawRange organ = organ_->range();
  return depth_of_force_m(*organ_, force_N, force_N < 0.0 ? organ.pull_m : organ.press_m);
}

double SeriesLaw::compliance_at_m_per_N(double displacement_m) const RT_SAFE {
  if (organ_ == nullptr) return compliance_m_per_N_;
  constexpr double kSoftest_N_per_m = 1e-9;  // flat: all further depth is the organ's
  return 1.0 / std::fmax(organ_->respond(displacement_m).stiffness_N_per_m, kSoftest_N_per_m);
}

// SL-1  d = e + r F(e)
double SeriesLaw::depth_of(double indentation_m) const RT_SAFE {
  return indentation_m + displacement_m(law_->respond(indentation_m).force_N);
}

/// The indentation whose depth this is; the depth grows with it.
double SeriesLaw::indentation_at(double depth_m) const RT_SAFE {
  // 0 is an end of both brackets, which a Newton step may
  // not reach: it would be halved towards for ever.
  if (depth_m == 0.0) return 0.0;
  double low_m = depth_m > 0.0 ? 0.0 : indentation_.pull_m;
  double high_m = depth_m > 0.0 ? indentation_.press_m : 0.0;
  double indentation_m = std::clamp(depth_m, low_m, high_m);
  for (int i = 0; i < kMaxIterations; ++i) {
    const LawResponse at = law_->respond(indentation_m);
    const double moved_m = displacement_m(at.force_N);
    const double miss_m = indentation_m + moved_m - depth_m;
    (miss_m < 0.0 ? low_m : high_m) = indentation_m;
    double next_m =
        indentation_m - miss_m / (1.0 + compliance_at_m_per_N(moved_m) * at.stiffness_N_per_m);
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
  const double moved_m = displacement_m(out.force_N);
  // SL-2, SL-3
  out.energy_J += organ_ != nullptr ? organ_->respond(moved_m).energy_J
                                    : 0.5 * compliance_m_per_N_ * out.force_N * out.force_N;
  out.stiffness_N_per_m /= 1.0 + compliance_at_m_per_N(moved_m) * out.stiffness_N_per_m;
  return beyond_limit(out, inside_m, depth_m);
}

// SL-4. A compliance below zero would raise the damping above the law's own: it counts as none.
double SeriesLaw::damping_Ns_per_m(double depth_m) const RT_SAFE {
  if (!(depth_m > 0.0) || !std::isfinite(depth_m)) return 0.0;
  const double indentation_m = indentation_at(std::min(depth_m, range_.press_m));
  const LawResponse at = law_->respond(indentation_m);
  const double moved_m = displacement_m(at.force_N);
  const double compliance_m_per_N = std::max(compliance_at_m_per_N(moved_m), 0.0);
  const double share = 1.0 / (1.0 + compliance_m_per_N * at.stiffness_N_per_m);
  const double own_Ns_per_m = law_->damping_Ns_per_m(indentation_m) * share * share;
  if (organ_ == nullptr) return own_Ns_per_m;
  return own_Ns_per_m + organ_->damping_Ns_per_m(moved_m) * (1.0 - share) * (1.0 - share);  // SL-6
}

Result<SeriesLaw> make_series_law(const Law& law, double compliance_m_per_N, const Law& shape) {
  const double most_N_per_m = stiffest_N_per_m(law, law.range().pull_m, law.range().press_m);
  if (!(1.0 + compliance_m_per_N * most_N_per_m > 0.0) || !std::isfinite(compliance_m_per_N))
    return Error{
        fmt::format("law in series: a compliance of {:g} m/N with a law of up to {:g} N/m; "
                    "allowed: finite and above "
                    "-1 / stiffness",
                    compliance_m_per_N, most_N_per_m)};
  return SeriesLaw(law, nullptr, compliance_m_per_N, shape);
}

Result<SeriesLaw> make_series_law(const Law& law, const Law& organ) {
  for (const Law* each : {&law, &organ})
    if (falls(*each))
      return Error{"its force falls as its depth grows, so it cannot be in series with a tip"};
  return SeriesLaw(law, &organ, 0.0, law);
}

}  // namespace tact::model::law
