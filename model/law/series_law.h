// SPDX-License-Identifier: Apache-2.0
// series_law.h - a law in series with a linear compliance, or with another law: indentation by the
// tip plus displacement of the organ.
//
//     SL-1   d = e + r F(e)                     e: indentation of the law F, r F: displacement
//     SL-2   U = U(e) + r F(e)^2 / 2
//     SL-3   1/K = 1/K(e) + r
//     SL-4   b = b(e) / (1 + r K(e))^2          e' = d' / (1 + r K(e)), the same loss; r < 0: b(e)
//
//     SL-5   r = y / F, F = F_organ(y); in SL-3 and SL-4 r = 1/K_organ(y); U + U_organ(y) in SL-2
//     SL-6   b = b(e) / (1 + r K(e))^2 + b_organ(y) (r K(e) / (1 + r K(e)))^2
//
//     d   depth, m     F   force, N     U   energy, J     K   stiffness, N/m
//     r   compliance of the organ at this surface point that the law does not include, m/N;
//         negative near the fixed boundary, everywhere above -1/K of the law
//
// Valid until indentation or depth reaches the range of the law, or the organ ends; beyond, the
// force is constant. The profile comes from another law, which includes the displacement of the
// organ. respond() solves SL-1, for set-up and tools; the loop reads a table.
#pragma once

#include <cmath>

#include "model/law/law.h"
#include "model/result.h"

namespace tact::model::law {

class SeriesLaw final : public Law {
 public:
  LawResponse respond(double depth_m) const RT_SAFE override;
  double damping_Ns_per_m(double depth_m) const RT_SAFE override;
  LawRange range() const RT_SAFE override { return range_; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override {
    return shape_->profile(range_.pull_m < 0.0 ? depth_m : std::fmax(depth_m, 0.0), ring_m);
  }
  double ring_pitch_m() const RT_SAFE override { return shape_->ring_pitch_m(); }

 private:
  friend Result<SeriesLaw> make_series_law(const Law&, double, const Law&);
  friend Result<SeriesLaw> make_series_law(const Law&, const Law&);
  SeriesLaw(const Law& law, const Law* organ, double compliance_m_per_N, const Law& shape);
  /// Of the organ under this force.
  double displacement_m(double force_N) const RT_SAFE;
  double compliance_at_m_per_N(double displacement_m) const RT_SAFE;
  double depth_of(double indentation_m) const RT_SAFE;
  double indentation_at(double depth_m) const RT_SAFE;

  const Law* law_;
  const Law* organ_;  // nullptr: linear
  const Law* shape_;
  double compliance_m_per_N_;
  LawRange indentation_;  // the law's own, or where the organ ends
  LawRange range_;
};

/// Both laws must outlive it. An error if the compliance makes the pair unstable.
Result<SeriesLaw> make_series_law(const Law& law, double compliance_m_per_N, const Law& shape);

/// On an organ of another law. An error if a force falls as its depth grows.
Result<SeriesLaw> make_series_law(const Law& law, const Law& organ);

}  // namespace tact::model::law
