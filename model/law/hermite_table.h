// SPDX-License-Identifier: Apache-2.0
// hermite_table.h - a curve and its integral, from value and slope at uniform knots.
//
//     F(t) = F0 + m0 t + c2 t^2 + c3 t^3,      t = (x - x_k) / h in [0, 1]
//     c2 = 3 D - 2 m0 - m1,  c3 = m0 + m1 - 2 D,  D = F1 - F0,  m = h F'
//     U(t) = U0 + h (F0 t + m0 t^2 / 2 + c2 t^3 / 3 + c3 t^4 / 4)
//
// U is the exact integral of the interpolated F, so force and energy agree up to rounding for any
// knots. Evaluation is O(1) and has no state.
#pragma once

#include <cstddef>
#include <vector>

#include "model/rt.h"

namespace tact::model::law {

inline constexpr std::size_t kMaxKnots = 257;

struct CurvePoint {
  double value = 0.0, slope = 0.0, integral = 0.0;
};

class HermiteTable {
 public:
  HermiteTable() = default;

  /// Knots at x_k = k h, k = 0 .. knots - 1; h may be negative. `curve(x)` gives value and slope.
  template <typename Curve>
  HermiteTable(double step, std::size_t knots, const Curve& curve) : step_(step), cell_(knots - 1) {
    double integral = 0.0;
    CurvePoint here = curve(0.0);
    for (std::size_t k = 0; k < cell_.size(); ++k) {
      const CurvePoint next = curve(static_cast<double>(k + 1) * step);
      const double m0 = step * here.slope, m1 = step * next.slope, d = next.value - here.value;
      cell_[k] = {here.value, m0, 3.0 * d - 2.0 * m0 - m1, m0 + m1 - 2.0 * d, integral};
      integral = evaluate(cell_[k], 1.0).integral;
      here = next;
    }
  }

  std::size_t memory_bytes() const { return cell_.size() * sizeof(Cell); }
  /// x of the last knot.
  double end() const RT_SAFE { return step_ * static_cast<double>(cell_.size()); }

  /// The curve at x between 0 and end(); the caller has checked x.
  CurvePoint at(double x) const RT_SAFE {
    const double u = x / step_;
    std::size_t k = u > 0.0 ? static_cast<std::size_t>(u) : 0;
    if (k >= cell_.size()) k = cell_.size() - 1;
    return evaluate(cell_[k], u - static_cast<double>(k));
  }

 private:
  struct Cell {
    double f0 = 0.0, m0 = 0.0, c2 = 0.0, c3 = 0.0, u0 = 0.0;
  };

  CurvePoint evaluate(const Cell& c, double t) const RT_SAFE {
    return {.value = c.f0 + t * (c.m0 + t * (c.c2 + t * c.c3)),
            .slope = (c.m0 + t * (2.0 * c.c2 + t * 3.0 * c.c3)) / step_,
            .integral =
                c.u0 + step_ * t * (c.f0 + t * (c.m0 / 2.0 + t * (c.c2 / 3.0 + t * c.c3 / 4.0)))};
  }

  double step_ = 1.0;
  std::vector<Cell> cell_{Cell{}};
};

}  // namespace tact::model::law
