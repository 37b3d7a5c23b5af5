#include "model/relaxation.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tact::model {

RelaxationState Relaxation::after(const RelaxationState& before, double depth_m,
                                  bool held) const RT_SAFE {
  RelaxationState now{.depth_m = depth_m};
  for (std::size_t i = 0; i < count_; ++i) {
    const double e = fade_[i] * before.stretch_m[i] + gain_[i] * (depth_m - before.depth_m);
    now.stretch_m[i] = held ? e : std::max(e, 0.0);
  }
  return now;
}

Result<Relaxation> make_relaxation(std::span<const PronyTerm> terms, double tick_s) {
  if (terms.size() > kMaxPronyTerms)
    return Error{"relaxation: " + std::to_string(terms.size()) +
                 " terms; allowed: 3 at most, merge those with close times"};
  if (!(tick_s > 0.0)) return Error{"relaxation: the tick must last longer than 0 s"};
  Relaxation out;
  for (const PronyTerm& term : terms) {
    if (!(term.share > 0.0) || !(term.time_s > 0.0) || !std::isfinite(term.time_s))
      return Error{"relaxation: share = " + std::to_string(term.share) + " with time_s = " +
                   std::to_string(term.time_s) + "; allowed: both above 0 and finite"};
    const double a = std::exp(-tick_s / term.time_s);
    out.fade_[out.count_] = a;
    out.gain_[out.count_] = -std::expm1(-tick_s / term.time_s) * term.time_s / tick_s;
    out.share_[++out.count_] = term.share;
    out.share_[0] -= term.share;
  }
  constexpr double kRounding = 1e-12;  // 1 - 0.8 - 0.2 is a little below 0
  if (!(out.share_[0] >= -kRounding))
    return Error{"relaxation: the shares add up to " + std::to_string(1.0 - out.share_[0]) +
                 "; allowed: 1 or less, the rest is the force that stays"};
  out.share_[0] = std::max(out.share_[0], 0.0);
  return out;
}

}  // namespace tact::model
