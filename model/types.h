// SPDX-License-Identifier: Apache-2.0
// types.h - the few shapes every layer shares. SI units; frame W outside hal: right-handed, origin
// in the middle of the workspace, +x towards the operator, +y to the right, +z up.
#pragma once

#include <cmath>

#include "model/rt.h"

namespace tact::model {

struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;

  constexpr Vec3& operator+=(const Vec3& o) RT_SAFE { return x += o.x, y += o.y, z += o.z, *this; }
  constexpr Vec3& operator-=(const Vec3& o) RT_SAFE { return x -= o.x, y -= o.y, z -= o.z, *this; }
  constexpr Vec3& operator*=(double s) RT_SAFE { return x *= s, y *= s, z *= s, *this; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(Vec3 a, const Vec3& b) RT_SAFE { return a += b; }
constexpr Vec3 operator-(Vec3 a, const Vec3& b) RT_SAFE { return a -= b; }
constexpr Vec3 operator-(const Vec3& a) RT_SAFE { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, double s) RT_SAFE { return a *= s; }
constexpr Vec3 operator*(double s, Vec3 a) RT_SAFE { return a *= s; }
constexpr Vec3 operator/(const Vec3& a, double s) RT_SAFE { return {a.x / s, a.y / s, a.z / s}; }

constexpr double dot(const Vec3& a, const Vec3& b) RT_SAFE {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(const Vec3& a, const Vec3& b) RT_SAFE {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec3& a) RT_SAFE { return std::sqrt(dot(a, a)); }
inline bool is_finite(const Vec3& a) RT_SAFE {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
/// Unit vector along a; a zero vector stays zero.
inline Vec3 normalized(const Vec3& a) RT_SAFE {
  const double n = norm(a);
  return n > 0.0 ? a / n : Vec3{};
}
/// What of v lies across the unit vector `normal`.
constexpr Vec3 tangential(const Vec3& v, const Vec3& normal) RT_SAFE {
  return v - dot(v, normal) * normal;
}

/// Unit quaternion, Hamilton product: rotates from the tool frame to W.
struct Quat {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;

  friend constexpr bool operator==(const Quat&, const Quat&) = default;
};

constexpr Quat operator*(const Quat& a, const Quat& b) RT_SAFE {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
/// p' = q p q^-1, without building the matrix.
constexpr Vec3 rotate(const Quat& q, const Vec3& p) RT_SAFE {
  const Vec3 u{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(u, p);
  return p + q.w * t + cross(u, t);
}
constexpr Quat conjugate(const Quat& q) RT_SAFE { return {q.w, -q.x, -q.y, -q.z}; }
/// q of a rotation vector (axis times angle, rad).
inline Quat quat_from_rotation_vector(const Vec3& r_rad) RT_SAFE {
  const double angle_rad = norm(r_rad);
  if (!(angle_rad > 0.0)) return {};
  const double s = std::sin(0.5 * angle_rad) / angle_rad;
  return {std::cos(0.5 * angle_rad), s * r_rad.x, s * r_rad.y, s * r_rad.z};
}

/// What the device knows of the tool, frame W.
struct Tool {
  Vec3 position_m{};
  Quat orientation{};
  Vec3 velocity_mps{};
  Vec3 angular_velocity_radps{};
  double grip_ratio = 0.0;  // 0 open, 1 closed
};

/// What the device does to the hand, at the tool's origin, frame W.
struct Wrench {
  Vec3 force_N;
  Vec3 torque_Nm;

  friend constexpr bool operator==(const Wrench&, const Wrench&) = default;
};

inline bool is_finite(const Tool& tool) RT_SAFE {
  const Quat& q = tool.orientation;
  return is_finite(tool.position_m) && is_finite(tool.velocity_mps) &&
         is_finite(tool.angular_velocity_radps) && std::isfinite(tool.grip_ratio) &&
         std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}
inline bool is_finite(const Wrench& w) RT_SAFE {
  return is_finite(w.force_N) && is_finite(w.torque_Nm);
}

}  // namespace tact::model
