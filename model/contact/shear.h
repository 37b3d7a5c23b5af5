// SPDX-License-Identifier: Apache-2.0
// shear.h - spheres that drag one tissue sideways: a spring each, coupled as their presses are.
//
//     MC-4   t_i = f_i / k_t + sum over j != i of c_ij f_j        W = sum f_i . t_i / 2
//            |f_i| <= mu F_i unless held (Coulomb)
//
//     t_i   sideways displacement of site i, m, tangential to n_i      f_i   force that it takes, N
//     c     MC-2, kept so small that I / k_t + c is positive definite
//
// Half-space: across the line that joins two sites c is right, along it a factor of 1 / (1 - nu) is
// left out [Johnson, Contact Mechanics (1985), 3.6].
#pragma once

#include <array>
#include <cstddef>

#include "model/contact/coupling.h"

namespace tact::model::contact {

class Shear {
 public:
  Shear() = default;
  /// k_t >= 0; the coupling of what presses.
  Shear(double stiffness_N_per_m, const Coupling& c,
        const std::array<bool, kMaxSpheres>& presses) RT_SAFE;

  /// df_i / dt_i, N/m; 0: it does not press.
  double own_N_per_m(std::size_t i) const RT_SAFE { return stiffness_N_per_m_[i][i]; }
  /// f_i for displacements t, before it is laid into the tangent plane.
  Vec3 force_N(const std::array<Vec3, kMaxSpheres>& t_m, std::size_t i) const RT_SAFE;
  /// t_i with which f_i is 0, where the others' forces are f.
  Vec3 unloaded_m(const std::array<Vec3, kMaxSpheres>& f_N, std::size_t i) const RT_SAFE;

 private:
  Coupling coupling_{};           // C, limited
  Coupling stiffness_N_per_m_{};  // (I / k_t + C)^-1 of what presses, 0 elsewhere
};

}  // namespace tact::model::contact
