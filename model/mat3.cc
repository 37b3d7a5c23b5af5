// SPDX-License-Identifier: Apache-2.0
#include "model/mat3.h"

#include <algorithm>

namespace tact::model {

std::array<double, 3> singular_values(const Mat3& a) RT_SAFE {
  // Its eigenvalues are the squares of the singular values, and it is symmetric: Jacobi's method.
  std::array<std::array<double, 3>, 3> g{};  // A A^T
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) g[i][j] = dot(a.row[i], a.row[j]);
  constexpr int kSweeps = 8;  // converges quadratically: five are enough for a double
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t k = 0; k < 3; ++k) {
      // The pairs (0 1), (0 2), (1 2); r is the third axis.
      const std::size_t p = k == 2 ? 1 : 0, q = k == 0 ? 1 : 2, r = 3 - p - q;
      if (!(std::abs(g[p][q]) > 0.0)) continue;
      // t = sign(w) / (|w| + sqrt(w^2 + 1)),  w = (g_qq - g_pp) / (2 g_pq)
      const double w = (g[q][q] - g[p][p]) / (2.0 * g[p][q]);
      const double t = std::copysign(1.0, w) / (std::abs(w) + std::sqrt(w * w + 1.0));
      const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
      g[p][p] -= t * g[p][q];
      g[q][q] += t * g[p][q];
      g[p][q] = g[q][p] = 0.0;
      const double rp = g[r][p], rq = g[r][q];
      g[r][p] = g[p][r] = c * rp - s * rq;
      g[r][q] = g[q][r] = s * rp + c * rq;
    }
  }
  std::array<double, 3> sigma{};
  // Rounding can leave the square of a vanishing value a little below zero.
  for (std::size_t i = 0; i < 3; ++i) sigma[i] = g[i][i] > 0.0 ? std::sqrt(g[i][i]) : 0.0;
  // Three compare-exchanges instead of a sort that may recurse.
  if (sigma[0] < sigma[1]) std::swap(sigma[0], sigma[1]);
  if (sigma[1] < sigma[2]) std::swap(sigma[1], sigma[2]);
  if (sigma[0] < sigma[1]) std::swap(sigma[0], sigma[1]);
  return sigma;
}

}  // namespace tact::model
