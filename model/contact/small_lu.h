// SPDX-License-Identifier: Apache-2.0
// small_lu.h - linear equations of at most N unknowns, factorised once and solved often, without
// allocation: P A = L U by elimination, with optional row exchange. Only the part in use is written
// or read, so N costs no time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "model/rt.h"

namespace tact::model::contact {

/// kOfColumn: the largest of its column, by row exchange. kOfDiagonal: the diagonal element; for a
/// symmetric matrix all pivots are > 0 if and only if it is positive definite.
enum class Pivot : std::uint8_t { kOfColumn, kOfDiagonal };

template <std::size_t N>
class SmallLu {
 public:
  using Column = std::array<double, N>;

  SmallLu() RT_SAFE {}
  /// Element of A, to be set before each factorise().
  double& at(std::size_t row, std::size_t column) RT_SAFE { return lu_[row][column]; }
  /// Factorises the first n rows and columns in place. False if a pivot is not above least_pivot;
  /// solve() must then not be called.
  bool factorise(std::size_t n, Pivot pivot, double least_pivot) RT_SAFE {
    n_ = n;
    for (std::size_t k = 0; k < n; ++k) {  // bound: unknowns
      std::size_t best = k;
      // bound: unknowns - 1; half in all
      for (std::size_t i = k + 1; pivot == Pivot::kOfColumn && i < n; ++i)
        if (std::abs(lu_[i][k]) > std::abs(lu_[best][k])) best = i;
      const double least = pivot == Pivot::kOfColumn ? std::abs(lu_[best][k]) : lu_[best][k];
      if (!(least > least_pivot)) return false;
      // bound: unknowns
      if (best != k) std::swap_ranges(lu_[best].begin(), lu_[best].begin() + n, lu_[k].begin());
      row_[k] = best;
      const double inverse = 1.0 / lu_[k][k];
      for (std::size_t i = k + 1; i < n; ++i) {  // bound: unknowns - 1; half in all
        lu_[i][k] *= inverse;
        // bound: unknowns - 1
        for (std::size_t j = k + 1; j < n; ++j) lu_[i][j] -= lu_[i][k] * lu_[k][j];
      }
    }
    return true;
  }

  /// Solves A x = b; x replaces b.
  void solve(Column& b) const RT_SAFE {
    for (std::size_t k = 0; k < n_; ++k) std::swap(b[k], b[row_[k]]);  // bound: unknowns
    for (std::size_t k = 1; k < n_; ++k)                               // bound: unknowns
      // bound: unknowns - 1; half in all
      for (std::size_t j = 0; j < k; ++j) b[k] -= lu_[k][j] * b[j];
    for (std::size_t k = n_; k-- > 0;) {  // bound: unknowns
      // bound: unknowns - 1; half in all
      for (std::size_t j = k + 1; j < n_; ++j) b[k] -= lu_[k][j] * b[j];
      b[k] /= lu_[k][k];
    }
  }

 private:
  using Square = std::array<std::array<double, N>, N>;  // [row][column]

  Square lu_;
  std::array<std::size_t, N> row_;  // exchanged with k
  std::size_t n_ = 0;
};

}  // namespace tact::model::contact
