// SPDX-License-Identifier: Apache-2.0
// relaxation.h - a standard linear solid in series with any law: force that fades at held depth.
//
// The law's energy U is shared out: g_0 stays, each Prony term g_i forgets with its time tau_i
// (g_0 + sum g_i = 1). Term i feels its own stretch e_i, which flows back to zero, so that what it
// adds at held depth, g_i F(e_i), fades as exp(-t / tau_i) whatever the law (RX-1 to RX-4):
//
//     W   = g_0 U(d) + sum g_i U(e_i)            F = g_0 F(d) + sum g_i F(e_i)
//     e_i' = d' - F(e_i) / (tau_i F'(e_i)) = d' - q_i e_i / tau_i       q = F(e) / (e F'(e))
//     e_i <- (1 - x b) e_i + b (d - d_before)       x = q_i dt / tau_i,  b = (1 - exp(-x)) / x
//
// q_i is that of the tick before: 1 for a spring, 2/3 for a ball on a half-space. For a power law
// and a depth that is linear over the tick, the tick is exact. The term's dashpot loses
// g_i F(e_i) q_i e_i / tau_i >= 0: passive for every law whose force has the sign of its depth, and
// for every q_i > 0, so q_i decides about precision only. Memory acting on the force instead (a
// convolution) is passive for a linear law alone. Tissue that is not held cannot pull: there e_i
// stays at or above zero, what that drops is lost.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "model/law/law.h"
#include "model/result.h"
#include "model/rt.h"

namespace tact::model::law {

inline constexpr std::size_t kMaxPronyTerms = 3;

struct PronyTerm {
  double share = 0.0;   // g_i, of the force at once, > 0
  double time_s = 0.0;  // tau_i, > 0
};

/// What one touched contact point remembers.
struct RelaxationState {
  double depth_m = 0.0;
  std::array<double, kMaxPronyTerms> stretch_m{};                // e_i
  std::array<double, kMaxPronyTerms> flow_ratio{1.0, 1.0, 1.0};  // q_i
};

/// q of a law at this stretch; 1 without force, and at most 4: a law beyond its range has F' = 0,
/// and its stretch comes back in bounded steps.
double flow_ratio(double stretch_m, const LawResponse& at_stretch) RT_SAFE;

class Relaxation {
 public:
  /// No terms: nothing fades.
  Relaxation() = default;

  std::size_t terms() const RT_SAFE { return count_; }
  /// g_0 for `term` 0, g_i after it.
  double share(std::size_t term) const RT_SAFE { return share_[term]; }
  /// dt / tau of the term g_(i + 1).
  double rate_per_tick(std::size_t i) const RT_SAFE { return tick_share_[i]; }
  /// One tick later at this depth; `held` tissue may be stretched outward. The flow ratios are for
  /// the caller to set, who knows the law; left alone, they are those of a spring.
  RelaxationState after(const RelaxationState& before, double depth_m, bool held) const RT_SAFE;

 private:
  friend Result<Relaxation> make_relaxation(std::span<const PronyTerm>, double);

  std::size_t count_ = 0;
  std::array<double, kMaxPronyTerms + 1> share_{1.0};
  std::array<double, kMaxPronyTerms> tick_share_{};  // dt / tau_i
};

/// `tick_s` is the fixed time between two calls of after(). Shares must leave g_0 >= 0.
Result<Relaxation> make_relaxation(std::span<const PronyTerm> terms, double tick_s);

}  // namespace tact::model::law
