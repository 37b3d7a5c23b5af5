// SPDX-License-Identifier: Apache-2.0
// disc.h - one coned disc spring: constants from dimensions, and force.
//
//     DS-1  C = D / d
//     DS-2  alpha = (1/pi) ((C-1)/C)^2 / ((C+1)/(C-1) - 2/ln C)
//     DS-3  k = 4 E/(1 - mu^2) l^3/(alpha D^2)
//     DS-4  h0 = H0 - l,  eta = h0/l,  force to flat = k h0
//     DS-5  f(s) = k s (1 + eta^2 (1-x)(1-x/2)),  x = s/h0      Almen-Laszlo
//           f(s) = k s                                          linear
//
//     D, d  outer and inner diameter, m      l   thickness, m     H0  free height, m
//     E     Young's modulus, Pa              mu  Poisson's ratio
//     s     flattening, m, 0 .. h0           k   secant stiffness to flat, N/m
//
// The Almen-Laszlo disc starts stiffer (k (1 + eta^2)) and ends softer (k (1 - eta^2/2)); above
// eta = sqrt(2) it snaps through, and one force has several flattenings. Source: DS-1 to DS-5.
#pragma once

#include <cstdint>

#include "model/parameters.h"
#include "model/result.h"
#include "model/rt.h"

namespace tact::model::indent {

enum class DiscForm : std::uint8_t { kAlmenLaszlo, kLinear };

struct DiscDimensions {
  double outer_diameter_m = 0.0;  // D, above d
  double inner_diameter_m = 0.0;  // d, > 0
  double thickness_m = 0.0;       // l, > 0
  double free_height_m = 0.0;     // H0, above l
  double youngs_modulus_Pa = 0.0;
  double poisson_ratio = 0.0;  // below 0.5
};
void visit(ParameterVisitor& v, DiscDimensions& p);

/// Constants of a disc that a stack needs.
struct Disc {
  double outer_diameter_m = 0.0;   // D
  double stiffness_N_per_m = 0.0;  // k
  double travel_m = 0.0;           // h0
  double cone_ratio = 0.0;         // eta; not used by the linear form

  double flat_force_N() const RT_SAFE { return stiffness_N_per_m * travel_m; }
};

struct DiscResponse {
  double force_N = 0.0;
  double stiffness_N_per_m = 0.0;
  double energy_J = 0.0;
};

/// alpha of DS-2 for C = D/d above 1; accurate down to the thinnest ring.
double disc_shape_factor(double diameter_ratio) RT_SAFE;

/// The force grows all the way to flat: eta <= sqrt(2).
bool is_monotone(const Disc& disc, DiscForm form) RT_SAFE;

/// DS-5 and its slope and integral; 0 <= s <= h0.
DiscResponse respond(const Disc& disc, DiscForm form, double flattening_m) RT_SAFE;

/// The s with f(s) = F for 0 <= F <= k h0; the disc must be monotone.
double flattening_at_m(const Disc& disc, DiscForm form, double force_N) RT_SAFE;

/// DS-1 to DS-4. The error names the dimension and what is allowed.
Result<Disc> make_disc(const DiscDimensions& dimensions);

/// nullptr, or what is wrong with a disc given by its stiffness and travel.
const char* disc_error(const Disc& disc, DiscForm form);

}  // namespace tact::model::indent
