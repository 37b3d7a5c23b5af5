// SPDX-License-Identifier: Apache-2.0
// mat3.h - the 3 by 3 matrix that the loop needs: fixed size, no heap, no exceptions.
//
//     A^-1 = [ r1 x r2 | r2 x r0 | r0 x r1 ] / det A,     det A = r0 . (r1 x r2)
//
// with the rows r0 r1 r2 of A. A singular or non-finite matrix has the inverse zero here, so that a
// force computed through it lets go instead of growing without bound.
#pragma once

#include <array>
#include <cmath>

#include "model/types.h"

namespace tact::model {

struct Mat3 {
  std::array<Vec3, 3> row{};

  friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
};

constexpr Mat3 diagonal(double s) RT_SAFE {
  return {{Vec3{s, 0.0, 0.0}, Vec3{0.0, s, 0.0}, Vec3{0.0, 0.0, s}}};
}
constexpr Mat3 transpose(const Mat3& a) RT_SAFE {
  return {{Vec3{a.row[0].x, a.row[1].x, a.row[2].x}, Vec3{a.row[0].y, a.row[1].y, a.row[2].y},
           Vec3{a.row[0].z, a.row[1].z, a.row[2].z}}};
}
constexpr Vec3 operator*(const Mat3& a, const Vec3& v) RT_SAFE {
  return {dot(a.row[0], v), dot(a.row[1], v), dot(a.row[2], v)};
}
constexpr Mat3 operator*(const Mat3& a, const Mat3& b) RT_SAFE {
  const Mat3 columns = transpose(b);
  return {{columns * a.row[0], columns * a.row[1], columns * a.row[2]}};
}
constexpr Mat3 operator*(double s, const Mat3& a) RT_SAFE {
  return {{s * a.row[0], s * a.row[1], s * a.row[2]}};
}
constexpr Mat3 operator+(const Mat3& a, const Mat3& b) RT_SAFE {
  return {{a.row[0] + b.row[0], a.row[1] + b.row[1], a.row[2] + b.row[2]}};
}
constexpr double determinant(const Mat3& a) RT_SAFE {
  return dot(a.row[0], cross(a.row[1], a.row[2]));
}

/// A^-1, or zero when A has none to working precision or is not finite.
inline Mat3 inverse(const Mat3& a) RT_SAFE {
  const double det = determinant(a);
  const double size = norm(a.row[0]) * norm(a.row[1]) * norm(a.row[2]);
  if (!(std::abs(det) > 1e-13 * size)) return {};
  return transpose({{cross(a.row[1], a.row[2]) / det, cross(a.row[2], a.row[0]) / det,
                     cross(a.row[0], a.row[1]) / det}});
}

/// Singular values of A, descending: roots of the eigenvalues of A A^T by eight Jacobi sweeps.
std::array<double, 3> singular_values(const Mat3& a) RT_SAFE;

}  // namespace tact::model
