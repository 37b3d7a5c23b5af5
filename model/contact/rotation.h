// SPDX-License-Identifier: Apache-2.0
// rotation.h - rotation of a surface point of a bending organ: the whole rotation, the part of it
// that gives the direction of the displacement, and the moment of a load on the slope.
//
//     Q = exp(theta u),   Q^k = exp(k theta u),   theta = atan|z|,   u = n x z / |z|
//
//     n  normal at rest   z  slope of the moved surface, across n: Q turns n to (n + z) / |n + z|
//     k  chord ratio      exp(theta u) the rotation about u by theta, rad
#pragma once

#include <cmath>

#include "model/types.h"

namespace tact::model::contact {

struct SineCosine {
  double sine = 0.0, cosine = 1.0;
};

struct Rotation {
  Vec3 normal;                            // n
  Vec3 slope;                             // z
  Vec3 axis;                              // u, or 0 without a slope
  double tangent = 0.0, angle_rad = 0.0;  // |z|, theta
  SineCosine whole, chord, rest;          // of theta, k theta and (1 - k) theta
};

/// v rotated about a unit axis; v itself if the axis is 0.
inline Vec3 rotated(const SineCosine& by, const Vec3& axis, const Vec3& v) RT_SAFE {
  return by.cosine * v + by.sine * cross(axis, v) + ((1.0 - by.cosine) * dot(axis, v)) * axis;
}

inline Rotation rotation_of_slope(const Vec3& normal, const Vec3& slope,
                                  double chord_ratio) RT_SAFE {
  constexpr double kMinTangent = 1e-12;
  Rotation out;
  out.normal = normal, out.slope = slope;
  const double x = norm(slope);
  if (!(x > kMinTangent)) return out;
  out.axis = cross(normal, slope) / x;
  out.tangent = x;
  out.angle_rad = std::atan(x);
  const double c = 1.0 / std::sqrt(1.0 + x * x), s = x * c;
  out.whole = {s, c};
  out.chord = {std::sin(chord_ratio * out.angle_rad), std::cos(chord_ratio * out.angle_rad)};
  out.rest = {s * out.chord.cosine - c * out.chord.sine, c * out.chord.cosine + s * out.chord.sine};
  return out;
}

/// J' z: J is the left Jacobian of the rotation by the angle phi about the axis,
/// J = sin phi / phi I + (1 - sin phi / phi) u u' + (1 - cos phi) / phi [u x].
inline Vec3 jacobian_transposed(const SineCosine& of, double angle_rad, const Vec3& axis,
                                const Vec3& z) RT_SAFE {
  constexpr double kMinAngle_rad = 1e-9;
  if (!(angle_rad > kMinAngle_rad)) return z;
  const double s = of.sine / angle_rad, c = (1.0 - of.cosine) / angle_rad;
  return s * z + ((1.0 - s) * dot(axis, z)) * axis - c * cross(axis, z);
}

/// Moment on the slope, N m: -d/dz of load . (Q^k shift + Q arm) at a fixed load. All three vectors
/// are after rotation: the load on the tool, Q^k shift and Q arm.
inline Vec3 moment_on_slope(const Rotation& q, double chord_ratio, const Vec3& load_N,
                            const Vec3& turned_shift_m, const Vec3& turned_arm_m) RT_SAFE {
  const Vec3 on_chord = jacobian_transposed(q.chord, chord_ratio * q.angle_rad, q.axis,
                                            cross(load_N, turned_shift_m));
  const Vec3 on_arm =
      jacobian_transposed(q.whole, q.angle_rad, q.axis, cross(load_N, turned_arm_m));
  const Vec3 m = chord_ratio * on_chord + on_arm;
  // d(theta u) = s n x dz + (ds/dx) / x (z . dz) n x z,   s = atan(x) / x,   x = |z|
  const double x = q.tangent;
  const double s = x > 1e-6 ? q.angle_rad / x : 1.0;
  const double bend = x > 1e-3 ? (1.0 / (1.0 + x * x) - s) / (x * x) : -2.0 / 3.0 + 0.8 * x * x;
  return s * cross(m, q.normal) + (bend * dot(m, x * q.axis)) * q.slope;
}

}  // namespace tact::model::contact
