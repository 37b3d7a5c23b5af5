// SPDX-License-Identifier: Apache-2.0
// inertia.h - speed of a press above which tissue inertia matters, which no law includes.
//
// A pressed half-space radiates waves: a dashpot parallel to its spring.
//
//     IN-1   F_wave = c v,   c = 3.4 a^2 sqrt(rho G) / (1 - nu)
//     IN-2   v_q = q F(d) / c        small indentations: v_q = 0.78 q sqrt(G / rho) sqrt(d / R)
//
//     F_wave  force missing in the law, N  v    speed of the press, m/s
//     F(d)    force of the half-space, N   v_q  where F_wave is the share q of F(d), m/s
//     a       radius of contact, m         rho  density, kg/m^3
//
// IN-1 is that of a rigid disc on a half-space, for motions slower than a wave needs across the
// contact [J. Lysmer, F. Richart, J. Soil Mech. Found. Div. ASCE 92 SM1 (1966) 65]; F(d), a, G and
// nu as in compliance_tip.h. Set-up code only.
#pragma once

#include "model/indent/compliance_tip.h"

namespace tact::model::indent {

inline constexpr double kTissueDensity_kg_per_m3 = 1060.0;  // of liver and muscle, within 3 %

/// IN-2 at small strain; depth_m > 0.
double inertia_speed_mps(const ElasticTip& tip, double depth_m, double share);

}  // namespace tact::model::indent
