// SPDX-License-Identifier: Apache-2.0
// hertz_load.h - a smooth patch of pressure on the skin of a body, and what a half-space gives it.
//
//     p(rho) = (3 F / (2 pi a0^2)) sqrt(1 - rho^2 / a0^2)        Hertz, rho <= a0
//     w_a    = integral of p N_a dA / F,  sum w_a = 1            share of F that node a carries
//     C      = sum w_a u_a                                       displacement as the load feels it
//
// A force on one point of a continuum sinks without limit: its displacement is a property of the
// mesh alone. Spread over a patch of known size it has a limit, and that of a half-space is exact:
//
//     normal       u(rho) = 3 F (2 a0^2 - rho^2) / (8 E* a0^3)   inside;   C_n = 3 / (5 E* a0)
//     tangential   C_t    = 3 (2 - nu) / (20 G a0)
//
//     a0   patch radius, m      rho   straight distance from the middle of the patch, m
//     E*   E / (1 - nu^2), Pa   G     shear modulus, Pa
//
// [Johnson, Contact Mechanics (1985), 3.4 and 3.6.] The patch is grown from triangle to triangle,
// so that it never reaches the far side of a thin lobe. Offline only.
#pragma once

#include "model/fem/boundary.h"
#include "model/fem/elasticity.h"

namespace tact::model::fem {

struct NodeWeight {
  std::uint32_t node = 0;
  double weight = 0.0;  // w_a
};

/// Weights of the patch around a node of the skin, mid-side nodes too; sum 1. Empty where the patch
/// is too small for the triangles: it falls between the points at which the pressure is summed.
std::vector<NodeWeight> hertz_weights(const TetMesh& mesh, const Boundary& boundary,
                                      std::uint32_t centre, double radius_m);

/// Displacement of a half-space at rho under unit normal force, m/N.
double hertz_displacement_m_per_N(const Elasticity& material, double radius_m, double rho_m);
/// C_n and C_t, m/N.
double hertz_normal_m_per_N(const Elasticity& material, double radius_m);
double hertz_tangential_m_per_N(const Elasticity& material, double radius_m);

}  // namespace tact::model::fem
