// SPDX-License-Identifier: Apache-2.0
#include "model/contact/shear.h"

#include <algorithm>

namespace tact::model::contact {

Shear::Shear(const OwnGives& own, const Coupling& c,
             const std::array<bool, kMaxSpheres>& presses) RT_SAFE {
  // Rows that sum to less than the diagonal: positive definite, and so is what elimination leaves.
  constexpr double kMost = 0.9 / (kMaxSpheres - 1);
  const auto takes = [&](std::size_t i) RT_SAFE { return presses[i] && own[i].m_per_N > 0.0; };
  Coupling a{};
  for (std::size_t i = 0; i < kMaxSpheres; ++i)
    for (std::size_t j = 0; j < kMaxSpheres; ++j) {
      const double most_m_per_N = kMost * std::min(own[i].least_m_per_N, own[j].least_m_per_N);
      if (i != j && takes(i) && takes(j))
        coupling_[i][j] = std::clamp(c[i][j], -most_m_per_N, most_m_per_N);
      a[i][j] = i != j ? coupling_[i][j] : takes(i) ? own[i].m_per_N : 1.0;
      stiffness_N_per_m_[i][j] = i == j && takes(i) ? 1.0 : 0.0;
    }
  // Gauss and Jordan: a becomes the unit matrix, the unit matrix the inverse.
  for (std::size_t k = 0; k < kMaxSpheres; ++k) {
    const double pivot = a[k][k];
    for (std::size_t j = 0; j < kMaxSpheres; ++j) {
      a[k][j] /= pivot;
      stiffness_N_per_m_[k][j] /= pivot;
    }
    for (std::size_t i = 0; i < kMaxSpheres; ++i) {
      if (i == k) continue;
      const double f = a[i][k];
      if (f == 0.0) continue;
      for (std::size_t j = 0; j < kMaxSpheres; ++j) {
        a[i][j] -= f * a[k][j];
        stiffness_N_per_m_[i][j] -= f * stiffness_N_per_m_[k][j];
      }
    }
  }
}

Vec3 Shear::force_N(const std::array<Vec3, kMaxSpheres>& t_m, std::size_t i) const RT_SAFE {
  Vec3 sum{};
  for (std::size_t j = 0; j < kMaxSpheres; ++j)
    if (stiffness_N_per_m_[i][j] != 0.0) sum += stiffness_N_per_m_[i][j] * t_m[j];
  return sum;
}

Vec3 Shear::unloaded_m(const std::array<Vec3, kMaxSpheres>& f_N, std::size_t i) const RT_SAFE {
  Vec3 sum{};
  for (std::size_t j = 0; j < kMaxSpheres; ++j)
    if (coupling_[i][j] != 0.0) sum += coupling_[i][j] * f_N[j];
  return sum;
}

}  // namespace tact::model::contact
