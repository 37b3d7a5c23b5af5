// SPDX-License-Identifier: Apache-2.0
// shear.h - spheres that drag one tissue sideways: a spring each, coupled as their presses are.
//
//     MC-4   t_i = f_i / k_i + sum over j != i of c_ij f_j        W = sum f_i . t_i / 2
//            |f_i| <= mu F_i unless held (Coulomb)
//
//     t_i   sideways displacement of site i, m, tangential to n_i      f_i   force that it takes, N
//     k_i   MC-5, N/m: stiffer while the contact grows
//     c     h + b of MC-2, kept so small that diag(1 / k) + c is positive definite
//
// Half-space: across the line that joins two sites h is right, along it a factor of 1 / (1 - nu) is
// left out [Johnson, Contact Mechanics (1985), 3.6]. b is that of the normal motion: what a lobe's
// sideways motion at one site is at the other, the map does not know.
#pragma once

#include <array>
#include <cstddef>

#include "model/contact/coupling.h"

namespace tact::model::contact {

/// 1 / k_i now, and the least that it may become; 0: it takes no force.
struct OwnGive {
  double m_per_N = 0.0, least_m_per_N = 0.0;
};
using OwnGives = std::array<OwnGive, kMaxSpheres>;

class Shear {
 public:
  Shear() = default;
  /// The coupling of what presses.
  Shear(const OwnGives& own, const Coupling& c,
        const std::array<bool, kMaxSpheres>& presses) RT_SAFE;

  /// df_i / dt_i, N/m; 0: it does not press.
  double own_N_per_m(std::size_t i) const RT_SAFE { return stiffness_N_per_m_[i][i]; }
  /// f_i for displacements t, before it is laid into the tangent plane.
  Vec3 force_N(const std::array<Vec3, kMaxSpheres>& t_m, std::size_t i) const RT_SAFE;
  /// t_i with which f_i is 0, where the others' forces are f.
  Vec3 unloaded_m(const std::array<Vec3, kMaxSpheres>& f_N, std::size_t i) const RT_SAFE;

 private:
  Coupling coupling_{};           // C, limited
  Coupling stiffness_N_per_m_{};  // (diag(1 / k) + C)^-1 of what presses, 0 elsewhere
};

}  // namespace tact::model::contact
