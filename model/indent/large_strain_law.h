// SPDX-License-Identifier: Apache-2.0
// large_strain_law.h - a law that was fitted to a round tip at small strain, at large strain.
//
//     LS-1   F_large = g(d/R) F                               d > 0; g of CT-8
//     LS-2   dF_large/dd = g dF/dd + F (dg/dx) / R,   U_large = integral of F_large
//
//     d   indentation by the tip alone, m    F   force of the law, N    R   tip radius, m
//
// A table over the law's range in press, so U is the exact integral of the force that is rendered.
// Pull, damping and shape of the indentation are the law's own. g is fitted up to 2.15 R
// (compliance_tip.h); beyond it stays, but for its small term in a/R.
#pragma once

#include "model/indent/compliance_tip.h"
#include "model/law/hermite_table.h"
#include "model/law/law.h"
#include "model/result.h"

namespace tact::model::indent {

class LargeStrainLaw final : public law::Law {
 public:
  law::LawResponse respond(double depth_m) const RT_SAFE override;
  double damping_Ns_per_m(double depth_m) const RT_SAFE override {
    return small_->damping_Ns_per_m(depth_m);
  }
  law::LawRange range() const RT_SAFE override { return {small_->range().pull_m, press_.end()}; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override {
    return small_->profile(depth_m, ring_m);
  }
  double ring_pitch_m() const RT_SAFE override { return small_->ring_pitch_m(); }
  std::size_t memory_bytes() const { return sizeof *this + press_.memory_bytes(); }

 private:
  friend Result<LargeStrainLaw> make_large_strain_law(const law::Law&, const ElasticTip&,
                                                      std::size_t);
  explicit LargeStrainLaw(const law::Law& small) : small_(&small) {}

  const law::Law* small_;
  law::HermiteTable press_;
};

/// `small` must outlive it; of `tip`, radius and Poisson's ratio count. An error if the force would
/// fall with depth.
Result<LargeStrainLaw> make_large_strain_law(const law::Law& small, const ElasticTip& tip,
                                             std::size_t knots);

}  // namespace tact::model::indent
