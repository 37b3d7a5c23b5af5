// SPDX-License-Identifier: Apache-2.0
#include "model/contact/shear.h"

#include <algorithm>
#include <cmath>

#include "model/contact/small_lu.h"

namespace tact::model::contact {

void Shear::set_own(std::size_t i, const OwnCompliance& own) RT_SAFE {
  if ((own_[i].least_m_per_N > 0.0) != (own.least_m_per_N > 0.0)) is_recoupled_ = true;
  own_[i] = own;
}

void Shear::leave(std::size_t i) RT_SAFE {
  set_own(i, {});
  for (std::size_t j = 0; j < count_; ++j) couple(i, j, 0.0, {}, {});  // bound: spheres
}

// The matrix is diagonally dominant, hence positive definite.
void Shear::couple(std::size_t i, std::size_t j, double m_per_N, const Axes& of_i,
                   const Axes& of_j) RT_SAFE {
  constexpr double kAll = 0.9, kPair = kAll / 3.0;
  double most_m_per_N = kPair * std::min(own_[i].least_m_per_N, own_[j].least_m_per_N);
  for (const auto [a, b] : {std::array{i, j}, std::array{j, i}}) {  // bound: 2 (orders)
    double left_m_per_N = kAll * own_[a].least_m_per_N;
    for (std::size_t k = 0; k < count_; ++k)  // bound: spheres
      if (k != b) left_m_per_N -= std::abs(pair_m_per_N_[a][k]);
    most_m_per_N = std::min(most_m_per_N, std::max(left_m_per_N, 0.0));
  }
  const double c = std::clamp(m_per_N, -most_m_per_N, most_m_per_N);
  is_recoupled_ = true;
  pair_m_per_N_[i][j] = pair_m_per_N_[j][i] = c;
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t q = 0; q < 2; ++q)
      coupling_m_per_N_[2 * i + p][2 * j + q] = coupling_m_per_N_[2 * j + q][2 * i + p] =
          c * dot(of_i.unit[p], of_j.unit[q]);
}

void Shear::solve() RT_SAFE {
  std::size_t pressing = 0, changed = 0;
  for (std::size_t i = 0; i < count_; ++i) {  // bound: spheres
    if (own_[i].least_m_per_N > 0.0) ++pressing;
    if (!(own_[i] == solved_[i])) ++changed;
  }
  if (is_recoupled_ || 2 * changed >= pressing)
    invert();
  else
    for (std::size_t i = 0; i < count_; ++i)  // bound: spheres
      if (!(own_[i] == solved_[i])) update(i);
  solved_ = own_;
  is_recoupled_ = false;
}

double Shear::compliance_m_per_N(std::size_t row, std::size_t column) const RT_SAFE {
  if (row / 2 != column / 2) return coupling_m_per_N_[row][column];
  const Tensor2& own = own_[row / 2].m_per_N;
  return row != column ? own.xy : row % 2 == 0 ? own.xx : own.yy;
}

// Inverts the matrix of the pressing spheres, column by column.
void Shear::invert() RT_SAFE {
  std::array<std::size_t, 2 * kMaxSpheres> row;
  std::size_t n = 0;
  for (std::size_t i = 0; i < count_; ++i)  // bound: spheres
    if (own_[i].least_m_per_N > 0.0) row[n++] = 2 * i, row[n++] = 2 * i + 1;
  SmallLu<2 * kMaxSpheres> lu;
  for (std::size_t i = 0; i < n; ++i)  // bound: 2 * spheres
    // bound: 2 * spheres
    for (std::size_t j = 0; j < n; ++j) lu.at(i, j) = compliance_m_per_N(row[i], row[j]);
  for (std::size_t i = 0; i < 2 * count_; ++i)                    // bound: 2 * spheres
    std::fill_n(stiffness_N_per_m_[i].begin(), 2 * count_, 0.0);  // bound: 2 * spheres
  if (!lu.factorise(n, Pivot::kOfDiagonal, 0.0)) return;
  for (std::size_t j = 0; j < n; ++j) {  // bound: 2 * spheres
    std::array<double, 2 * kMaxSpheres> unit{};
    unit[j] = 1.0;
    lu.solve(unit);
    // bound: 2 * spheres
    for (std::size_t i = 0; i < n; ++i) stiffness_N_per_m_[row[i]][row[j]] = unit[i];
  }
}

// One spring goes from G to G - D:   K <- K + K_:i M K_i:,   M = D (I - K_ii D)^-1
void Shear::update(std::size_t i) RT_SAFE {
  const Tensor2 k = own_N_per_m(i), &before = solved_[i].m_per_N, &now = own_[i].m_per_N;
  const Tensor2 d{before.xx - now.xx, before.xy - now.xy, before.yy - now.yy};
  const double b_xx = 1.0 - k.xx * d.xx - k.xy * d.xy, b_xy = -k.xx * d.xy - k.xy * d.yy;
  const double b_yx = -k.xy * d.xx - k.yy * d.xy, b_yy = 1.0 - k.xy * d.xy - k.yy * d.yy;
  const double det = b_xx * b_yy - b_xy * b_yx;
  const Tensor2 m{(d.xx * b_yy - d.xy * b_yx) / det, (d.xy * b_xx - d.xx * b_xy) / det,
                  (d.yy * b_xx - d.xy * b_xy) / det};
  const auto x = stiffness_N_per_m_[2 * i], y = stiffness_N_per_m_[2 * i + 1];
  for (std::size_t r = 0; r < 2 * count_; ++r) {  // bound: 2 * spheres
    const Vec2 row = m * Vec2{x[r], y[r]};
    for (std::size_t c = 0; c < 2 * count_; ++c)  // bound: 2 * spheres
      stiffness_N_per_m_[r][c] += row.x * x[c] + row.y * y[c];
  }
}

Tensor2 Shear::own_N_per_m(std::size_t i) const RT_SAFE {
  const Matrix& k = stiffness_N_per_m_;
  return {.xx = k[2 * i][2 * i], .xy = k[2 * i][2 * i + 1], .yy = k[2 * i + 1][2 * i + 1]};
}

Vec2 Shear::times(const Matrix& m, std::size_t i, const Shifts& v) const RT_SAFE {
  Vec2 sum{};
  for (std::size_t j = 0; j < count_; ++j) {  // bound: spheres
    sum.x += m[2 * i][2 * j] * v[j].x + m[2 * i][2 * j + 1] * v[j].y;
    sum.y += m[2 * i + 1][2 * j] * v[j].x + m[2 * i + 1][2 * j + 1] * v[j].y;
  }
  return sum;
}

}  // namespace tact::model::contact
