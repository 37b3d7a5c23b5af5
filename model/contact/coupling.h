// SPDX-License-Identifier: Apache-2.0
// coupling.h - spheres that press one tissue: each stands in the indentation that the others make.
//
//     MC-1   e_i = d_i - sum over j != i of C_ij F_j        F_i = dU_i/de at e_i
//            F_i >= 0 unless held: a sphere in an indentation deeper than its own depth is not
//            touched
//     MC-3   W(d) = sum U_i(e_i) + F' C F / 2               so that dW/dd_i = F_i
//
//     d_i   depth of a sphere below the undeformed surface, m
//     e_i   its own indentation, m: what the contact point's law answers
//     C_ij  sinking of contact point i under a unit force at contact point j, m/N; symmetric, C_ii
//           = 0
//
//     MC-2   C_ij = x h + x (3 - x^2) / 2 b,   x = n_i . n_j
//            h   near field of the ContactCoupling: half space, and what the organ lacks to one,
//                m/N
//            b   structural part of it: what the organ's bending adds, m/N
//
// The structural part was measured along the two normals. They straddle the axis along which it
// bends: so b keeps its size at any x near 1, and turns its sign on the other side of the lobe.
//
// With C constant W is a potential: no stroke gives back more than it took. The forces are unique
// where diag(1 / F'(e_i)) + C is positive definite, with the largest F' that each contact point's
// law can answer: with that of the moment, a law that saturates would let the indentations snap
// from one solution to another, and W with them. definite_share() tells how much of C may stay.
// Newton on e, at most kMaxSteps from the guess that it is given, to kTolerance_m. Where it finds
// nothing, as the matrix is not definite, half of C is tried, and in the end none.
#pragma once

#include <array>
#include <span>

#include "model/contact/contact_law.h"

namespace tact::model::contact {

/// C, m/N, of all pairs.
using Coupling = std::array<std::array<double, kMaxSpheres>, kMaxSpheres>;

/// One sphere of a tool. in.dent_m is e: a guess before press_together, the answer after it.
struct PressingSphere {
  bool presses = false;  // touches or is held; else the rest does not count
  double depth_m = 0.0;  // d
  Indentation in;
  ContactLawResponse response;  // at e
};

/// MC-2, m/N.
double coupling_m_per_N(const ContactCoupling& c, const Vec3& n_i, const Vec3& n_j) RT_SAFE;

/// Solves MC-1; returns W, J. C becomes smaller where it has no solution.
double press_together(ContactLaw& law, Coupling& c, std::span<PressingSphere> spheres) RT_SAFE;

/// sum over j of C_ij F_j, m: how far the others have sunk the contact point of sphere i.
double coupled_m(const Coupling& c, std::span<const PressingSphere> spheres, std::size_t i) RT_SAFE;

/// Largest factor of C, 0 .. 1, with which the matrix above is positive definite by a margin, for
/// the largest stiffness of each sphere's contact point.
double definite_share(const Coupling& c,
                      const std::array<double, kMaxSpheres>& stiffest_N_per_m) RT_SAFE;

}  // namespace tact::model::contact
