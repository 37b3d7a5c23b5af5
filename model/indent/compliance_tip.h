// SPDX-License-Identifier: Apache-2.0
// compliance_tip.h - indentation of a flat elastic half-space by a tool's tip.
//
// Press, a rigid sphere without friction [Sneddon, Int. J. Eng. Sci. 3 (1965) 47]: the contact
// patch grows with depth. With a = R tanh s,
//
//     CT-1   d = (a/2) ln((R + a) / (R - a))                       = R s tanh s
//     CT-2   F = E* [(R^2 + a^2)/2 ln((R + a) / (R - a)) - a R]    = E* [(R^2 + a^2) s - a R]
//     CT-3   dF/dd = 2 E* a
//     CT-4   u(rho) = d - R + sqrt(R^2 - rho^2)                                       rho <= a
//            u(rho) = (2/pi) integral of (d - R q tanh q) / sqrt(rho^2 - t^2) dt      rho > a
//                     over t = R tanh q = 0 .. a
//
// Large strain, F times a factor that depends on the indentation; 0 <= d <= 2.15 R:
//
//     CT-8   F_large = g F,  x = d / R,  w = 1 - 2 nu
//            g = 1 - 0.1210 x + 0.0651 x^2 - 0.0259 x^3 + w (0.2559 a/R + 0.2525 x)
//     CT-9   dF_large/dd = 2 E* a g + F (dg/dx) / R
//
// The form is ours; the term in a/R is for compressible tissue, which slides inwards under the tip.
// Fitted to a neo-Hookean block at nu = 0.3 and 0.49, within 0.8 % of its local force; within 0.9 %
// at nu = 0.45, which was held out of the fit (RF-7), and about 3 % at nu = 0.2 (RF-8).
// The indentation keeps the a and the shape u(rho) of CT-1 and CT-4 at the same depth.
//
// Pull, a bonded disc that moves without turning [Johnson, Contact Mechanics (1985), 3.7; Mindlin
// 1949]:
//
//     CT-5   F = 4 G R ln(3 - 4 nu) / (1 - 2 nu) d        outward
//     CT-6   F = 8 G R / (2 - nu) d                       sideways
//     CT-7   u(rho) = (2/pi) d asin(R / rho)              outside, as of a disc without friction
//
//     d   depth, m     F   force, N     a   radius of contact, m     u   into the tissue, m
//     R   tip radius, m      E* = E / (1 - nu^2), G = E / (2 (1 + nu)), Pa
//
// a stays below R at any depth: the tool's shaft is not modelled.
#pragma once

#include "model/rt.h"

namespace tact::model::indent {

struct ElasticTip {
  double youngs_modulus_Pa = 0.0;  // E, > 0
  double poisson_ratio = 0.0;      // nu
  double radius_m = 0.0;           // R, > 0
  bool large_strain = false;       // CT-8 instead of CT-2

  double contact_modulus_Pa() const RT_SAFE;          // E*
  double stiffest_press_N_per_m() const;              // of CT-3, or CT-9, at any depth; for set-up
  double pulled_stiffness_N_per_m() const RT_SAFE;    // CT-5
  double sideways_stiffness_N_per_m() const RT_SAFE;  // CT-6
};

/// A pressed tip.
struct TipState {
  double depth_m = 0.0;
  double force_N = 0.0;
  double stiffness_N_per_m = 0.0;
  double contact_radius_m = 0.0;
};

inline constexpr double kDeepestIndentation_ratio = 2.15;  // x, CT-8 is valid up to here

/// CT-8: g, and its slope dg/dx.
struct StrainFactor {
  double factor = 1.0, slope = 0.0;
};

/// At an indentation of x radii, x > 0; for set-up. Beyond kDeepestIndentation_ratio only the term
/// in a/R goes on.
StrainFactor large_strain_factor(double poisson_ratio, double x);

/// CT-1 to CT-3 at s >= 0, or CT-8 and CT-9, with x in g limited to kDeepestIndentation_ratio.
TipState tip_state(const ElasticTip& tip, double s) RT_SAFE;
/// CT-4, rho >= 0.
double pressed_shape_m(const ElasticTip& tip, const TipState& state, double rho_m) RT_SAFE;
/// CT-7 for d = 1.
double pulled_shape(const ElasticTip& tip, double rho_m) RT_SAFE;

}  // namespace tact::model::indent
