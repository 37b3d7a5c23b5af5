// SPDX-License-Identifier: Apache-2.0
// laws_in_series.h - two laws that carry one force: the indentation by a tip on top of the organ
// below.
//
//     SL-5   d = e + y,   F = F_tip(e) = F_organ(y)
//     SL-6   U = U_tip(e) + U_organ(y),   1/K = 1/K_tip + 1/K_organ
//     SL-7   b = (K / K_tip)^2 b_tip(e) + (K / K_organ)^2 b_organ(y)     the same loss
//
//     d   depth, m     e, y   share of the tip and of the organ, m     F   force, N
//     U   energy, J    K   stiffness, N/m     b   damping, N s/m
//
// Valid until one of both reaches the end of its range; a pair pulls where both do. The profile is
// that of the tip. respond() solves SL-5, for set-up and tools; the loop reads a table.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "model/law/law.h"
#include "model/result.h"

namespace tact::model::law {

class LawsInSeries final : public Law {
 public:
  LawResponse respond(double depth_m) const RT_SAFE override;
  double damping_Ns_per_m(double depth_m) const RT_SAFE override;
  LawRange range() const RT_SAFE override { return range_; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override {
    return tip_->profile(range_.pull_m < 0.0 ? depth_m : std::fmax(depth_m, 0.0), ring_m);
  }
  double ring_pitch_m() const RT_SAFE override { return tip_->ring_pitch_m(); }

 private:
  friend Result<LawsInSeries> make_laws_in_series(const Law&, const Law&);
  LawsInSeries(const Law& tip, const Law& organ);
  double tip_depth_m(double depth_m) const RT_SAFE;

  const Law* tip_;
  const Law* organ_;
  LawRange range_;
};

/// Both laws must outlive it. An error if the force of one falls as its depth grows.
Result<LawsInSeries> make_laws_in_series(const Law& tip, const Law& organ);

}  // namespace tact::model::law
