// SPDX-License-Identifier: Apache-2.0
// half_space.h - exact indentation of a flat, deep, linear elastic body without friction.
//
//     E* = E / (1 - nu^2), Elasticity::contact_modulus_Pa
//     flat punch of radius a      F = 2 E* a d
//     sphere of radius R          d = (a / 2) ln((R + a) / (R - a))
//                                 F = E* ((R^2 + a^2) / 2 ln((R + a) / (R - a)) - a R)
//
// a contact radius, d depth, F force. The sphere is a sphere, not Hertz's parabola: a stays below R
// at any depth. Source: I. N. Sneddon, Int. J. Eng. Sci. 3 (1965) 47, cases 6.1 and 6.5.
#pragma once

#include "tools/reference/calculix/calculix.h"

namespace tact::tools::reference {

double flat_punch_force_N(const Elasticity& material, double radius_m, double depth_m);

/// a of a sphere at a depth above 0.
double sphere_contact_radius_m(double sphere_radius_m, double depth_m);

double sphere_force_N(const Elasticity& material, double sphere_radius_m, double depth_m);

}  // namespace tact::tools::reference
