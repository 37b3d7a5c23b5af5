// SPDX-License-Identifier: Apache-2.0
#include "model/contact/shear.h"

#include <algorithm>

#include "model/contact/small_lu.h"

namespace tact::model::contact {

void Shear::leave(std::size_t i) RT_SAFE {
  own_[i] = {};
  for (std::size_t j = 0; j < kMaxSpheres; ++j) couple(i, j, 0.0, {}, {});
}

// The matrix is diagonally dominant, hence positive definite.
void Shear::couple(std::size_t i, std::size_t j, double m_per_N, const Axes& of_i,
                   const Axes& of_j) RT_SAFE {
  // Limit per pair: all pairs of a sphere together stay below its spring; 0.9 is a margin.
  constexpr double kMax = 0.9 / (kMaxSpheres - 1);
  const double most_m_per_N = kMax * std::min(own_[i].least_m_per_N, own_[j].least_m_per_N);
  const double c = std::clamp(m_per_N, -most_m_per_N, most_m_per_N);
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t q = 0; q < 2; ++q)
      coupling_m_per_N_[2 * i + p][2 * j + q] = coupling_m_per_N_[2 * j + q][2 * i + p] =
          c * dot(of_i.unit[p], of_j.unit[q]);
}

// Inverts the matrix of the pressing spheres, column by column.
void Shear::solve() RT_SAFE {
  using Lu = SmallLu<2 * kMaxSpheres>;
  std::array<std::size_t, 2 * kMaxSpheres> row{};
  std::size_t n = 0;
  Matrix whole = coupling_m_per_N_;
  for (std::size_t i = 0; i < kMaxSpheres; ++i) {
    const Tensor2& give = own_[i].m_per_N;
    whole[2 * i][2 * i] = give.xx, whole[2 * i + 1][2 * i + 1] = give.yy;
    whole[2 * i][2 * i + 1] = whole[2 * i + 1][2 * i] = give.xy;
    if (own_[i].least_m_per_N > 0.0) row[n++] = 2 * i, row[n++] = 2 * i + 1;
  }
  Lu::Square a{};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) a[i][j] = whole[row[i]][row[j]];
  stiffness_N_per_m_ = {};
  Lu lu;
  if (!lu.factorise(a, n, Pivot::kOfDiagonal, 0.0)) return;
  for (std::size_t j = 0; j < n; ++j) {
    Lu::Column unit{};
    unit[j] = 1.0;
    lu.solve(unit);
    for (std::size_t i = 0; i < n; ++i) stiffness_N_per_m_[row[i]][row[j]] = unit[i];
  }
}

Tensor2 Shear::own_N_per_m(std::size_t i) const RT_SAFE {
  const Matrix& k = stiffness_N_per_m_;
  return {.xx = k[2 * i][2 * i], .xy = k[2 * i][2 * i + 1], .yy = k[2 * i + 1][2 * i + 1]};
}

Vec2 Shear::times(const Matrix& m, std::size_t i, const Shifts& v) RT_SAFE {
  Vec2 sum{};
  for (std::size_t j = 0; j < kMaxSpheres; ++j) {
    sum.x += m[2 * i][2 * j] * v[j].x + m[2 * i][2 * j + 1] * v[j].y;
    sum.y += m[2 * i + 1][2 * j] * v[j].x + m[2 * i + 1][2 * j + 1] * v[j].y;
  }
  return sum;
}

}  // namespace tact::model::contact
