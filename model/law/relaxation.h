// SPDX-License-Identifier: Apache-2.0
// relaxation.h - Prony series for any law: the force relaxes at constant depth.
//
// The law's energy U is split: the part g_0 is elastic, each Prony term g_i relaxes with its time
// constant tau_i (g_0 + sum g_i = 1). Term i has a stretch e_i that returns to zero, so that at
// constant depth its force g_i F(e_i) decays as exp(-t / tau_i) for any law (RX-1 to RX-4):
//
//     W   = g_0 U(d) + sum g_i U(e_i)            F = g_0 F(d) + sum g_i F(e_i)
//     e_i' = d' - F(e_i) / (tau_i F'(e_i)) = d' - q_i e_i / tau_i       q = F(e) / (e F'(e))
//     e_i <- (1 - x b) e_i + b (d - d_before)       x = q_i dt / tau_i,  b = (1 - exp(-x)) / x
//
// q_i is that of the last tick: 1 for a spring, 2/3 for a ball on a half-space. The step is exact
// for a power law and a depth that is linear in time over the tick. The term's dashpot dissipates
// g_i F(e_i) q_i e_i / tau_i >= 0: passive for every law whose force has the sign of its depth, and
// for every q_i > 0, so q_i affects only accuracy. A convolution of the force would be passive only
// for a linear law. Tissue that is not held cannot pull: e_i is limited to >= 0, which dissipates
// the energy of a negative stretch.
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
  double share = 0.0;   // g_i, part of the instantaneous force, > 0
  double time_s = 0.0;  // tau_i, > 0
};

/// State of one contact point.
struct RelaxationState {
  double depth_m = 0.0;
  std::array<double, kMaxPronyTerms> stretch_m{};                // e_i
  std::array<double, kMaxPronyTerms> flow_ratio{1.0, 1.0, 1.0};  // q_i
};

/// q of a law at this stretch; 1 without force, at most 4: beyond the law's range F' = 0, and the
/// stretch returns in bounded steps.
double flow_ratio(double stretch_m, const LawResponse& at_stretch) RT_SAFE;

class Relaxation {
 public:
  /// Without terms nothing relaxes.
  Relaxation() = default;

  std::size_t terms() const RT_SAFE { return count_; }
  /// g_0 for `term` 0, g_i after it.
  double share(std::size_t term) const RT_SAFE { return share_[term]; }
  /// dt / tau of the term g_(i + 1).
  double rate_per_tick(std::size_t i) const RT_SAFE { return tick_share_[i]; }
  /// State after a tick at this depth; only `held` tissue may have negative stretch. The caller
  /// sets the flow ratios from the law; their defaults are those of a spring.
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
