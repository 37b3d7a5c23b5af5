// SPDX-License-Identifier: Apache-2.0
// coupling.h - normal forces of spheres that press the same tissue: each displaces the contact
// points of the others.
//
//     MC-1   e_i = d_i - sum over j != i of C_ij F_j        F_i = dU_i/de at e_i
//            F_i >= 0 unless held: 0 if the others displace the point by more than d_i
//     MC-3   W(d) = sum U_i(e_i) + F' C F / 2               so that dW/dd_i = F_i
//
//     d_i   depth of a sphere below the undeformed surface, m
//     e_i   indentation relative to the displaced contact point, m: input of the law
//     C_ij  displacement of contact point i under a unit force at contact point j, m/N; symmetric,
//           C_ii = 0
//
//     MC-2   C_ij = o h + o (3 - o^2) / 2 b,   o = n_i . n_j
//            h   near field of the ContactCoupling, m/N: half-space plus the organ's correction
//            b   its structural part, m/N: bending of the organ
//
// The structural part was measured along the two normals, which lie on both sides of the bending
// axis. So b is nearly constant at o near 1 and changes its sign on the other side of a lobe.
//
// With constant C, W is a potential: no stroke returns more energy than it took. The forces are
// unique if diag(1 / F'(e_i)) + C is positive definite for the largest F' of each contact point's
// law. The present F' is not enough: after saturation e and W could jump to another solution.
// definite_share() returns the permitted factor on C. press_together() solves for e by
// Newton's method, at most kMaxSteps from the given guess, to kTolerance_m. Without a solution it
// tries half of C, a quarter, and then none.
#pragma once

#include <array>
#include <span>

#include "model/contact/contact_law.h"

namespace tact::model::contact {

/// C, m/N, of all pairs.
using Coupling = std::array<std::array<double, kMaxSpheres>, kMaxSpheres>;

/// One sphere of a tool. in.indentation_m is e: a guess before press_together, then the solution.
struct PressingSphere {
  bool presses = false;  // in contact or held; else the other members are unused
  double depth_m = 0.0;  // d
  Indentation in;
  ContactLawResponse response;  // at e
};

/// MC-2, m/N.
double coupling_m_per_N(const ContactCoupling& c, const Vec3& n_i, const Vec3& n_j) RT_SAFE;

/// Solves MC-1; returns W, J. Reduces C if there is no solution.
double press_together(ContactLaw& law, Coupling& c, std::span<PressingSphere> spheres) RT_SAFE;

/// Coupled displacement of the contact point of sphere i, m: sum over j of C_ij F_j.
double coupled_m(const Coupling& c, std::span<const PressingSphere> spheres, std::size_t i) RT_SAFE;

/// Largest factor on C, 0 .. 1, for which the matrix above is positive definite with a margin.
double definite_share(const Coupling& c,
                      const std::array<double, kMaxSpheres>& stiffest_N_per_m) RT_SAFE;

}  // namespace tact::model::contact
