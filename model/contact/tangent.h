// SPDX-License-Identifier: Apache-2.0
// tangent.h - vectors and symmetric tensors along the surface, in two axes of a contact point.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "model/types.h"

namespace tact::model::contact {

struct Vec2 {
  double x = 0.0, y = 0.0;

  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

constexpr Vec2 operator+(const Vec2& a, const Vec2& b) RT_SAFE { return {a.x + b.x, a.y + b.y}; }
constexpr Vec2 operator-(const Vec2& a, const Vec2& b) RT_SAFE { return {a.x - b.x, a.y - b.y}; }
constexpr Vec2 operator*(double s, const Vec2& a) RT_SAFE { return {s * a.x, s * a.y}; }
constexpr double dot(const Vec2& a, const Vec2& b) RT_SAFE { return a.x * b.x + a.y * b.y; }
inline double norm(const Vec2& a) RT_SAFE { return std::sqrt(dot(a, a)); }

/// Symmetric.
struct Tensor2 {
  double xx = 0.0, xy = 0.0, yy = 0.0;

  friend constexpr bool operator==(const Tensor2&, const Tensor2&) = default;
  constexpr double trace() const RT_SAFE { return xx + yy; }
  constexpr double determinant() const RT_SAFE { return xx * yy - xy * xy; }
  double least_eigenvalue() const RT_SAFE {
    return 0.5 * (trace() - std::hypot(xx - yy, 2.0 * xy));
  }
};

constexpr Vec2 operator*(const Tensor2& t, const Vec2& v) RT_SAFE {
  return {t.xx * v.x + t.xy * v.y, t.xy * v.x + t.yy * v.y};
}
/// Raises both eigenvalues equally until none is below `least`.
inline Tensor2 at_least(const Tensor2& t, double least) RT_SAFE {
  const double lack = std::max(least - t.least_eigenvalue(), 0.0);
  return {t.xx + lack, t.xy, t.yy + lack};
}
/// t^-1 v; t is positive definite, or 0: then the answer is 0.
constexpr Vec2 solve(const Tensor2& t, const Vec2& v) RT_SAFE {
  const double d = t.determinant();
  if (!(d > 0.0)) return {};
  return {(t.yy * v.x - t.xy * v.y) / d, (t.xx * v.y - t.xy * v.x) / d};
}

/// Unit vectors: one along the surface, and n x that.
struct Axes {
  std::array<Vec3, 2> unit;

  constexpr Vec2 of(const Vec3& v) const RT_SAFE { return {dot(unit[0], v), dot(unit[1], v)}; }
  constexpr Vec3 vector(const Vec2& v) const RT_SAFE { return v.x * unit[0] + v.y * unit[1]; }
};

/// Axes for a normal that has turned, as near as possible to `before`; any axes if that is 0.
inline Axes axes_of(const Vec3& normal, const Axes& before = {}) RT_SAFE {
  constexpr double kMinTangentSquared =
      0.25;  // least square of a unit vector's part along the surface
  Vec3 a = tangential(before.unit[0], normal);
  if (!(dot(a, a) > kMinTangentSquared)) a = cross(before.unit[1], normal);
  if (!(dot(a, a) > kMinTangentSquared)) a = tangential({1.0, 0.0, 0.0}, normal);
  if (!(dot(a, a) > kMinTangentSquared)) a = tangential({0.0, 1.0, 0.0}, normal);
  a = normalized(a);
  return {{a, cross(normal, a)}};
}

}  // namespace tact::model::contact
