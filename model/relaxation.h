// relaxation.h - a standard linear solid in series with any law: force that fades at held depth.
//
// The law's energy U is shared out: g_0 stays, each Prony term g_i forgets with its time tau_i
// (g_0 + sum g_i = 1). Term i feels its own stretch e_i, which flows back to zero:
//
//     W   = g_0 U(d) + sum g_i U(e_i)            F = g_0 F(d) + sum g_i F(e_i)
//     e_i' = d' - e_i / tau_i                    exact for a depth that is linear over the tick:
//     e_i <- a_i e_i + b_i (d - d_before)        a_i = exp(-dt / tau_i)
//                                                b_i = (1 - a_i) tau_i / dt
//
// The term's dashpot loses g_i F(e_i) e_i / tau_i >= 0: passive for every law whose force has the
// sign of its depth, which memory acting on the force instead (a convolution) is not. A linear law
// held at one depth gives exactly F(t) / F(0) = g_0 + sum g_i exp(-t / tau_i). Tissue that is not
// held cannot pull: there e_i stays at or above zero, what that drops is lost.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "model/result.h"
#include "model/rt.h"

namespace tact::model {

inline constexpr std::size_t kMaxPronyTerms = 3;

struct PronyTerm {
  double share = 0.0;   // g_i, of the force at once, > 0
  double time_s = 0.0;  // tau_i, > 0
};

/// What one touched site remembers.
struct RelaxationState {
  double depth_m = 0.0;
  std::array<double, kMaxPronyTerms> stretch_m{};  // e_i
};

class Relaxation {
 public:
  /// No terms: nothing fades.
  Relaxation() = default;

  std::size_t terms() const RT_SAFE { return count_; }
  /// g_0 for `term` 0, g_i after it.
  double share(std::size_t term) const RT_SAFE { return share_[term]; }
  /// One tick later at this depth; `held` tissue may be stretched outward.
  RelaxationState after(const RelaxationState& before, double depth_m, bool held) const RT_SAFE;

 private:
  friend Result<Relaxation> make_relaxation(std::span<const PronyTerm>, double);

  std::size_t count_ = 0;
  std::array<double, kMaxPronyTerms + 1> share_{1.0};
  std::array<double, kMaxPronyTerms> fade_{}, gain_{};  // a_i, b_i
};

/// `tick_s` is the fixed time between two calls of after(). Shares must leave g_0 >= 0.
Result<Relaxation> make_relaxation(std::span<const PronyTerm> terms, double tick_s);

}  // namespace tact::model
