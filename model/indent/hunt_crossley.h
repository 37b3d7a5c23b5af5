// SPDX-License-Identifier: Apache-2.0
// hunt_crossley.h - a power law whose force grows with the speed of the press.
//
//     HC-1   F + b d' = F_w x^n (1 + lambda d'),   x = d / d_w
//     HC-2   U = F_w d_w x^(n+1) / (n + 1),   K = n F_w x^(n-1) / d_w,   b = lambda F
//
//     d    depth, m, press positive          d'  its speed, m/s, pressing positive
//     d_w  working depth, m                  F_w force at d_w without speed, N
//     n    exponent, 1.5 for a ball          lambda  dissipation, s/m
//
// [K. Hunt, F. Crossley, J. Appl. Mech. 42 (1975) 440.] The damping grows with the depth, so the
// force begins at zero at any speed of contact. U is the stored energy; b d'^2 is dissipated.
// Valid for 0 <= d <= d_w; beyond, F and b are constant. It cannot pull, and a release faster than
// 1/lambda has no force (LW-3). lambda holds for one tip and one tissue. The surface next to the
// tip is not modelled: u_1 = 0 at d_w.
#pragma once

#include "model/law/law.h"
#include "model/parameters.h"
#include "model/result.h"

namespace tact::model::indent {

struct HuntCrossleyParameters {
  double force_N = 0.0;              // F_w, > 0
  double working_depth_m = 0.0;      // d_w, > 0
  double exponent = 1.5;             // n
  double dissipation_s_per_m = 0.0;  // lambda, >= 0
};
void visit(ParameterVisitor& v, HuntCrossleyParameters& p);

class HuntCrossley final : public law::Law {
 public:
  law::LawResponse respond(double depth_m) const RT_SAFE override;
  double damping_Ns_per_m(double depth_m) const RT_SAFE override;
  law::LawRange range() const RT_SAFE override {
    return {.pull_m = 0.0, .press_m = p_.working_depth_m};
  }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return p_.working_depth_m; }

 private:
  friend Result<HuntCrossley> make_hunt_crossley(const HuntCrossleyParameters&);
  explicit HuntCrossley(const HuntCrossleyParameters& p) : p_(p) {}

  HuntCrossleyParameters p_;
};

/// The error names the parameter and what is allowed.
Result<HuntCrossley> make_hunt_crossley(const HuntCrossleyParameters& parameters);

}  // namespace tact::model::indent
