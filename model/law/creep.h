// SPDX-License-Identifier: Apache-2.0
// creep.h - growth of a linear compliance under load if the material relaxes (relaxation.h).
//
// R(t) = g_0 + sum g_i exp(-t / tau_i) is the relaxation of the modulus. The compliance is then the
// instantaneous one times J(t), with s^2 R(s) J(s) = 1 for the Laplace transforms [R. Christensen,
// Theory of Viscoelasticity (1982), 1.2]:
//
//     CP-1   J = 1 + sum c_j (1 - exp(-t / lambda_j))
//     CP-2   g_0 = sum g_i x / (1 / tau_i - x),   x = 1 / lambda_j
//     CP-3   1 / c_j = x sum g_i (1 / tau_i) / (1 / tau_i - x)^2
//     CP-4   b = sum c_j z_j,   z_j' = (a - z_j) / lambda_j      a + b in place of the load a
#pragma once

#include <array>
#include <cstddef>

#include "model/law/relaxation.h"
#include "model/types.h"

namespace tact::model::law {

/// z of one load, N.
using CreepState = std::array<Vec3, kMaxPronyTerms>;

class Creep {
 public:
  /// Without terms the compliance is constant.
  Creep() = default;
  explicit Creep(const Relaxation& relaxation);

  std::size_t terms() const RT_SAFE { return count_; }
  /// c_j
  double ratio(std::size_t j) const RT_SAFE { return share_[j]; }
  /// CP-4: b, N.
  Vec3 crept_N(const CreepState& state) const RT_SAFE {
    Vec3 sum;
    // bound: terms (of the creep)
    for (std::size_t j = 0; j < count_; ++j) sum += share_[j] * state[j];
    return sum;
  }
  /// One tick under the load a, N.
  void advance(CreepState& state, const Vec3& load_N) const RT_SAFE {
    // bound: terms (of the creep)
    for (std::size_t j = 0; j < count_; ++j) state[j] += tick_share_[j] * (load_N - state[j]);
  }

 private:
  std::size_t count_ = 0;
  std::array<double, kMaxPronyTerms> share_{};       // c_j
  std::array<double, kMaxPronyTerms> tick_share_{};  // 1 - exp(-dt / lambda_j)
};

}  // namespace tact::model::law
