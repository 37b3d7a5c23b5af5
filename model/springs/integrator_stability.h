// SPDX-License-Identifier: Apache-2.0
// integrator_stability.h - up to which step an integrator keeps an oscillator from growing.
//
//     z = h omega,  omega = sqrt(k / m),  zeta = c / (2 m omega)
//     state (x, h v):  state+ = M state
//
//     MA-10..15  M of each integrator
//     MA-16      stable  <=>  det M < 1,  1 - tr M + det M > 0,  1 + tr M + det M > 0      (Jury)
//     MA-17      z_max, stable for 0 < z < z_max; the undamped neutral cases count
//
// What surprises: midpoint-averaging with alpha = 3/8 has z_max = 0 without damping, and with
// alpha = 1/2 it has z_max = 1 / zeta from zeta = 1/2 upwards, less than explicit Euler from 0.707.
// Source: MA-10 to MA-17.
#pragma once

#include <array>

#include "model/springs/integrators.h"

namespace tact::model::springs {

using Amplification = std::array<double, 4>;  // M, row by row

/// z >= 0, zeta >= 0.
Amplification amplification(const Method& method, double z, double zeta);

constexpr double trace(const Amplification& m) { return m[0] + m[3]; }
constexpr double determinant(const Amplification& m) { return m[0] * m[3] - m[1] * m[2]; }
/// Growth a step, of the mode that grows most.
double spectral_radius(const Amplification& m);
/// MA-16: det M < 1 and |tr M| < 1 + det M (Jury's criterion).
bool is_stable(const Amplification& m);

/// MA-17; infinity for implicit Euler, 0 where no step is stable or an argument is not a number.
double largest_stable_z(const Method& method, double zeta);

}  // namespace tact::model::springs
