// SPDX-License-Identifier: Apache-2.0
// membrane.h - a tensioned membrane on a softening foundation, pressed by a round tip.
//
// The hexagonal sheet in the limit of small cells, under a tip that covers more of it with growing
// depth. With w(r) into the tissue and contact within r <= a:
//
//     HX-30  inside   w = d - r^2 / (2 R)
//     HX-31  outside  T (w'' + w' / r) = p(w),   w'(a) = -a / R,   w -> 0
//     HX-32  p(w) = k w / (1 + w / w_0)^g
//     HX-33  F = 2 pi R (integral of p from w(a) to d) + 2 pi T a^2 / R,   U = integral of F
//
//     d  depth, m     F  force, N     R    tip radius, m     T  tension, N/m
//     p  pressure of the foundation, Pa    k    at rest, Pa/m     w_0, g  its softening, m and 1
//
// The slope is continuous at a, so the tip has no line load. Solved at set-up for a row of contact
// radii: w(a) by bisection, HX-31 by Runge-Kutta; between them ln F is linear in ln d. The loop
// reads a table. Valid to the working depth; beyond, the force is constant. It cannot pull. The
// law has no profile next to the tip (u_1 = 0); the page draws that of a half-space.
#pragma once

#include "model/law/hermite_table.h"
#include "model/law/law.h"
#include "model/parameters.h"
#include "model/result.h"

namespace tact::model::indent {

struct MembraneParameters {
  double tension_N_per_m = 0.0;      // T
  double foundation_Pa_per_m = 0.0;  // k
  double softening_depth_m = 0.0;    // w_0
  double softening_exponent = 0.0;   // g
  double working_depth_m = 0.0;
};
void visit(ParameterVisitor& v, MembraneParameters& p);

class Membrane final : public law::Law {
 public:
  law::LawResponse respond(double depth_m) const RT_SAFE override;
  law::LawRange range() const RT_SAFE override { return {.pull_m = 0.0, .press_m = press_.end()}; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return press_.end(); }

 private:
  friend Result<Membrane> make_membrane(const MembraneParameters&, double);
  explicit Membrane(law::HermiteTable press) : press_(std::move(press)) {}

  law::HermiteTable press_;  // of F; its integral is U
};

/// The error names the parameter and what is allowed.
Result<Membrane> make_membrane(const MembraneParameters& parameters, double tip_radius_m);

}  // namespace tact::model::indent
