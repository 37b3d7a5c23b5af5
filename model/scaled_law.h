// scaled_law.h - a law times a factor: softer or stiffer, the same shape.
//
//     F = g F_law(d),   U = g U_law(d),   profile and range as the law's
#pragma once

#include "model/law.h"

namespace tact::model {

class ScaledLaw final : public Law {
 public:
  /// `law` outlives it; `factor` g > 0.
  ScaledLaw(const Law& law, double factor) : law_(&law), factor_(factor) {}

  LawResponse respond(double depth_m) const RT_SAFE override {
    LawResponse r = law_->respond(depth_m);
    r.force_N *= factor_;
    r.stiffness_N_per_m *= factor_;
    r.energy_J *= factor_;
    return r;
  }
  LawRange range() const RT_SAFE override { return law_->range(); }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override {
    return law_->profile(depth_m, ring_m);
  }
  double ring_pitch_m() const RT_SAFE override { return law_->ring_pitch_m(); }

 private:
  const Law* law_;
  double factor_;
};

}  // namespace tact::model
