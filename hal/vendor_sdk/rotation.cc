// SPDX-License-Identifier: Apache-2.0
#include "hal/vendor_sdk/rotation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace tact::hal::vendor_sdk {
namespace {

using model::Quat;
using model::Vec3;

/// R R^T = I within kNoRotation, det R = +1.
bool is_rotation(const double r[3][3]) {
  constexpr double kNoRotation = 1e-3;  // the vendor's angles have rounding of their own
  const Vec3 x{r[0][0], r[0][1], r[0][2]}, y{r[1][0], r[1][1], r[1][2]},
      z{r[2][0], r[2][1], r[2][2]};
  const double off[] = {dot(x, x) - 1.0, dot(y, y) - 1.0, dot(z, z) - 1.0,
                        dot(x, y),       dot(y, z),       dot(z, x)};
  // So written, a NaN is no rotation. The determinant is -1 for a mirror.
  return dot(cross(x, y), z) > 0.0 && std::all_of(std::begin(off), std::end(off), [](double one) {
           return std::abs(one) <= kNoRotation;
         });
}

}  // namespace

Quat quat_from_rotation(const double r[3][3]) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!is_rotation(r)) return {kNone, kNone, kNone, kNone};
  const double trace = r[0][0] + r[1][1] + r[2][2];
  const double square[4] = {1.0 + trace, 1.0 + 2.0 * r[0][0] - trace, 1.0 + 2.0 * r[1][1] - trace,
                            1.0 + 2.0 * r[2][2] - trace};  // 4 w^2, 4 x^2, 4 y^2, 4 z^2
  const auto largest = std::max_element(square, square + 4) - square;
  const double twice = std::sqrt(square[largest]), half = 0.5 / twice;
  const double wx = half * (r[2][1] - r[1][2]), wy = half * (r[0][2] - r[2][0]);
  const double wz = half * (r[1][0] - r[0][1]), xy = half * (r[1][0] + r[0][1]);
  const double xz = half * (r[0][2] + r[2][0]), yz = half * (r[2][1] + r[1][2]);
  switch (largest) {
    case 0:
      return {0.5 * twice, wx, wy, wz};
    case 1:
      return {wx, 0.5 * twice, xy, xz};
    case 2:
      return {wy, xy, 0.5 * twice, yz};
    default:
      return {wz, xz, yz, 0.5 * twice};
  }
}

Vec3 rotation_vector_rad(const Quat& q) RT_SAFE {
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  const Vec3 v{sign * q.x, sign * q.y, sign * q.z};
  const double s = norm(v);
  // Near zero the quotient loses its digits; there the vector part is half the angle.
  return s > 1e-12 ? v * (2.0 * std::atan2(s, sign * q.w) / s) : 2.0 * v;
}

}  // namespace tact::hal::vendor_sdk
