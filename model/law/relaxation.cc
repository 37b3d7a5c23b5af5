// SPDX-License-Identifier: Apache-2.0
#include "model/law/relaxation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tact::model::law {
namespace {

// RX-4, chosen. A sphere on a half-space has 2/3, a spring 1; only a law near its limit comes here.
constexpr double kMaxFlow = 4.0;

// RX-3: b, free of cancellation; the series is good to 1e-16 and three times as fast as expm1.
double gain(double x) RT_SAFE {
  if (x > 0.01) return -std::expm1(-x) / x;
  return 1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0))));
}

}  // namespace

// RX-4. Beyond the range of a law F' is 0, and q infinite or NaN: both fail the test and get
// the most.
double flow_ratio(double stretch_m, const LawResponse& at_stretch) RT_SAFE {
  if (at_stretch.force_N == 0.0) return 1.0;
  const double q = at_stretch.force_N / (stretch_m * at_stretch.stiffness_N_per_m);
  return q >= 0.0 && q < kMaxFlow ? q : kMaxFlow;
}

RelaxationState Relaxation::after(const RelaxationState& before, double depth_m,
                                  bool held) const RT_SAFE {
  RelaxationState now{.depth_m = depth_m};
  for (std::size_t i = 0; i < count_; ++i) {  // bound: terms (of the relaxation)
    const double x = before.flow_ratio[i] * tick_share_[i];
    const double b = gain(x);
    const double e = (1.0 - x * b) * before.stretch_m[i] + b * (depth_m - before.depth_m);
    // Tissue that is not held cannot pull: what would be below zero is let go, and its energy lost.
    now.stretch_m[i] = held ? e : std::max(e, 0.0);
  }
  return now;
}

Result<Relaxation> make_relaxation(std::span<const PronyTerm> terms, double tick_s) {
  if (terms.size() > kMaxPronyTerms)
    return Error{fmt::format(
        "relaxation: {} terms; allowed: 3 at most, merge those with close times", terms.size())};
  if (!(tick_s > 0.0)) return Error{"relaxation: the tick must last longer than 0 s"};
  Relaxation out;
  for (const PronyTerm& term : terms) {
    if (!(term.share > 0.0) || !(term.time_s > 0.0) || !std::isfinite(term.time_s))
      return Error{fmt::format(
          "relaxation: share = {:g} with time_s = {:g}; allowed: both above 0 and finite",
          term.share, term.time_s)};
    out.tick_share_[out.count_] = tick_s / term.time_s;
    out.share_[++out.count_] = term.share;
    // share_[0] is g_0, what no term takes: it began at 1.
    out.share_[0] -= term.share;
  }
  constexpr double kRounding = 1e-12;  // 1 - 0.8 - 0.2 is a little below 0
  if (!(out.share_[0] >= -kRounding))
    return Error{fmt::format(
        "relaxation: the shares add up to {:g}; allowed: 1 or less, the rest is the force that "
        "stays",
        1.0 - out.share_[0])};
  out.share_[0] = std::max(out.share_[0], 0.0);
  return out;
}

}  // namespace tact::model::law
