// SPDX-License-Identifier: Apache-2.0
// rhombus_paper.h - the rhombus chain as its source prints it, for comparison only.
//
// Equations (3) to (7), (11) and (12) of the paper with their literal signs: dtheta < 0 and dl < 0
// when pressed, F > 0 pulls. The tangential spring helps the load instead of resisting it, so the
// stiffness kN - kT tan^2(theta0) vanishes at 42.4 degrees for the printed liver and turns negative
// beyond, and equation (12) is half the force (X1 to X7). It must never drive a device: it is no
// model::law::Law, and no scene can choose it.
#pragma once

#include "model/indent/rhombus_unit.h"

namespace tact::tools::printed {

using model::indent::RhombusUnit;
using model::law::LawStatus;

/// Equations (3) to (6) of one unit at a given change of angle.
struct PaperUnit {
  double shortening_m = 0.0;       // dl, (4)
  double widening_m = 0.0;         // dv, (4)
  double stiffness_N_per_m = 0.0;  // D, the denominator of (6)
  double force_N = 0.0;            // (3)
  double energy_J = 0.0;           // of both springs, as summed in (12)
};
PaperUnit paper_forward(const RhombusUnit& unit, double angle_change_rad) RT_SAFE;

/// D0 = kN - kT tan^2(theta0), the printed small-strain stiffness.
double paper_initial_stiffness_N_per_m(const RhombusUnit& unit) RT_SAFE;
/// D0 is zero or negative within rounding: the printed law has no meaning.
bool paper_is_singular(const RhombusUnit& unit) RT_SAFE;

/// (6) divides by D: no finite value where D is zero within rounding.
bool paper_divides_by_zero(const RhombusUnit& unit, const PaperUnit& at) RT_SAFE;

/// Equation (6) solved for the angle: force in, shape out.
struct PaperInverse {
  double angle_change_rad = 0.0;
  double lambda = 0.0;
  PaperUnit unit{};
  double limit_N = 0.0;  // largest pull (F > 0) or press (F < 0) that has a solution
  LawStatus status = LawStatus::kOk;
};
PaperInverse paper_inverse(const RhombusUnit& unit, double force_N) RT_SAFE;

}  // namespace tact::tools::printed
