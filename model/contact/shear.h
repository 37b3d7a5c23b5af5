// SPDX-License-Identifier: Apache-2.0
// shear.h - tangential springs of spheres on the same tissue, one per sphere, coupled.
//
//     MC-4   t_i = G_i f_i + sum over j != i of (h + b) A_ij f_j,   W = sum f_i . t_i / 2
//            |f_i| <= mu F_i unless held (Coulomb)
//
//     t_i   tangential displacement of contact point i, m     f_i   its force, N: in two axes each
//     G_i   MC-5, m/N, a tensor: depends on the direction, and falls while the contact grows
//     h, b  of MC-2; their sum is limited so that diag(G) + (h + b) A is positive definite: by a
//           third of 0.9 of each of the two springs, and all of a sphere's by 0.9 of its spring
//     A_ij  projects the axes of j on those of i
//
// On a half-space h is exact across the line between two contact points; along it a factor of
// 1 / (1 - nu) is neglected [Johnson, Contact Mechanics (1985), 3.6]. b is that of the normal
// motion, as the compliance map has no tangential coupling. The axes of a contact point turn with
// its normal, G and A with them.
#pragma once

#include <array>
#include <cstddef>

#include "model/contact/contact_law.h"
#include "model/contact/tangent.h"

namespace tact::model::contact {

/// Present G, and its lower bound in any direction; 0: no force.
struct OwnCompliance {
  Tensor2 m_per_N;
  double least_m_per_N = 0.0;

  friend constexpr bool operator==(const OwnCompliance&, const OwnCompliance&) = default;
};

class Shear {
 public:
  using Shifts = std::array<Vec2, kMaxSpheres>;

  explicit Shear(std::size_t spheres = kMaxSpheres) RT_SAFE : count_(spheres) {}

  /// Each of these takes effect with the next solve().
  void set_own(std::size_t i, const OwnCompliance& own) RT_SAFE;
  void couple(std::size_t i, std::size_t j, double m_per_N, const Axes& of_i,
              const Axes& of_j) RT_SAFE;
  /// The sphere does not press: removes its spring and its couplings.
  void leave(std::size_t i) RT_SAFE;
  /// Only what has changed: O(n^2) for each of few springs, O(n^3) for many or a coupling.
  void solve() RT_SAFE;

  const OwnCompliance& own(std::size_t i) const RT_SAFE { return own_[i]; }
  /// df_i / dt_i, N/m; 0 if it does not press.
  Tensor2 own_N_per_m(std::size_t i) const RT_SAFE;
  /// f_i for displacements t, m.
  Vec2 force_N(const Shifts& t_m, std::size_t i) const RT_SAFE {
    return times(stiffness_N_per_m_, i, t_m);
  }
  /// The t_i for which f_i is 0 if the others' forces are f, N.
  Vec2 unloaded_m(const Shifts& f_N, std::size_t i) const RT_SAFE {
    return times(coupling_m_per_N_, i, f_N);
  }

 private:
  using Matrix = std::array<std::array<double, 2 * kMaxSpheres>, 2 * kMaxSpheres>;

  /// Rows of i.
  Vec2 times(const Matrix& m, std::size_t i, const Shifts& v) const RT_SAFE;
  double compliance_m_per_N(std::size_t row, std::size_t column) const RT_SAFE;
  void invert() RT_SAFE;
  void update(std::size_t i) RT_SAFE;

  std::size_t count_;                                        // spheres of the tool
  std::array<OwnCompliance, kMaxSpheres> own_{}, solved_{};  // now, and at the last solve()
  bool is_recoupled_ = false;                                // since the last solve()
  std::array<std::array<double, kMaxSpheres>, kMaxSpheres> pair_m_per_N_{};  // c, limited
  Matrix coupling_m_per_N_{};                                                // c P
  Matrix stiffness_N_per_m_{};  // (diag(G) + c P)^-1 of the pressing spheres, else 0
};

}  // namespace tact::model::contact
