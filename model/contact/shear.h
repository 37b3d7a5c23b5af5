// SPDX-License-Identifier: Apache-2.0
// shear.h - spheres that drag one tissue sideways: a spring each, coupled as their presses are.
//
//     MC-4   t_i = G_i f_i + sum over j != i of c_ij P_ij f_j        W = sum f_i . t_i / 2
//            |f_i| <= mu F_i unless held (Coulomb)
//
//     t_i   sideways displacement of contact point i, m       f_i   force that it takes, N: in two
//           axes each
//     G_i   MC-5, m/N, a tensor: another give in each direction, less while the contact grows
//     c     h + b of MC-2, kept so small that diag(G) + c P is positive definite
//     P_ij  turns the axes of j into those of i, without what lies along the normals
//
// Half-space: across the line that joins two contact points h is right, along it a factor of 1 / (1
// - nu) is left out [Johnson, Contact Mechanics (1985), 3.6]. b is that of the normal motion,
// as the map has no sideways coupling between contact points. The axes of a contact point turn with
// its normal, G and c P with them.
#pragma once

#include <array>
#include <cstddef>

#include "model/contact/contact_law.h"
#include "model/contact/tangent.h"

namespace tact::model::contact {

/// G now, and the least that it may become in any direction; 0: it takes no force.
struct OwnCompliance {
  Tensor2 m_per_N;
  double least_m_per_N = 0.0;

  friend constexpr bool operator==(const OwnCompliance&, const OwnCompliance&) = default;
};

class Shear {
 public:
  using Shifts = std::array<Vec2, kMaxSpheres>;

  /// Each of these counts from the next solve() on.
  void set_own(std::size_t i, const OwnCompliance& own) RT_SAFE { own_[i] = own; }
  void couple(std::size_t i, std::size_t j, double m_per_N, const Axes& of_i,
              const Axes& of_j) RT_SAFE;
  /// It does not press: no force, no coupling.
  void leave(std::size_t i) RT_SAFE;
  void solve() RT_SAFE;

  const OwnCompliance& own(std::size_t i) const RT_SAFE { return own_[i]; }
  /// df_i / dt_i, N/m; 0: it does not press.
  Tensor2 own_N_per_m(std::size_t i) const RT_SAFE;
  /// f_i for displacements t, m.
  Vec2 force_N(const Shifts& t_m, std::size_t i) const RT_SAFE {
    return times(stiffness_N_per_m_, i, t_m);
  }
  /// t_i with which f_i is 0, where the others' forces are f, N.
  Vec2 unloaded_m(const Shifts& f_N, std::size_t i) const RT_SAFE {
    return times(coupling_m_per_N_, i, f_N);
  }

 private:
  using Matrix = std::array<std::array<double, 2 * kMaxSpheres>, 2 * kMaxSpheres>;

  /// Rows of i.
  static Vec2 times(const Matrix& m, std::size_t i, const Shifts& v) RT_SAFE;

  std::array<OwnCompliance, kMaxSpheres> own_{};
  Matrix coupling_m_per_N_{};   // c P, limited
  Matrix stiffness_N_per_m_{};  // (diag(G) + c P)^-1 of what takes force, 0 elsewhere
};

}  // namespace tact::model::contact
