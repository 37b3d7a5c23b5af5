// SPDX-License-Identifier: Apache-2.0
// limiter.h - vector limits that the stages of the gate share: magnitude, slew, and work or power
// along a motion.
//
//     magnitude   |F| <= limit                             direction kept
//     approach    |F - F_before| <= step, |F| <= radius    or |F| falls by `shrink` towards radius
//     surplus     F . d + T . a <= most                    least change, along the motion only
//
// Approach first reduces the magnitude, then uses the remaining slew for the direction: on a
// straight line to the goal the magnitude would fall more slowly than the slew allows. After
// skipped periods `shrink` is the slew of the whole time since the last write, `step` that of one
// period: a force may fall by the whole time, but grows and turns by one period. NaN becomes zero.
#pragma once

#include <limits>

#include "model/types.h"

namespace tact::firmware::gate {

using model::Vec3;
using model::Wrench;

/// |v| <= limit. Compares squares first, to save the root: sqrt(fl(limit^2)) is exactly limit.
inline bool is_within(const Vec3& v, double limit) RT_SAFE {
  return (limit >= 0.0 && dot(v, v) <= limit * limit) || norm(v) <= limit;
}

/// True if it shortened v.
inline bool limit_magnitude(Vec3& v, double limit) RT_SAFE {
  if (is_within(v, limit)) return false;
  const double length = norm(v);
  // The factor keeps |v| <= limit despite rounding. With u = 2^-53 the relative error of a norm is
  // at most 2.5 u: 3 u of the square, halved by the root, plus 1 u of the root. Two norms and three
  // operations: 8 u < 9 u, the margin. Above kNothing the underflow in a square is far below u.
  constexpr double kRoundingRoom = 1.0 - 1e-15;
  constexpr double kNothing = 1e-150;  // below it squares are denormal and a norm is inaccurate
  v = length > 0.0 && limit > kNothing ? (kRoundingRoom * limit / length) * v : Vec3{};
  if (!is_finite(v)) v = {};
  return true;
}

/// Limits v to one tick's change from `before`. True if it changed v. Needs `shrink` >= `step`.
inline bool approach(Vec3& v, const Vec3& before, double step, double shrink,
                     double radius) RT_SAFE {
  if (is_within(v, radius) && is_within(v - before, step)) return false;
  const double length = norm(before);
  const double reach = std::fmax(radius, length - shrink);
  Vec3 from = before;
  const double shrunk = limit_magnitude(from, reach) ? length - norm(from) : 0.0;
  bool held = limit_magnitude(v, reach);
  Vec3 change = v - from;
  if (limit_magnitude(change, std::fmax(step - shrunk, 0.0))) {
    v = from + change;
    limit_magnitude(v, reach);  // removes a rounding error of one ulp
    held = true;
  }
  return held;
}

/// Reduces v . d by `surplus`, by a change along d. If the square of d is denormal, d counts as
/// zero: a division by it would be inaccurate or infinite.
inline bool take_along(Vec3& v, double surplus, const Vec3& d) RT_SAFE {
  const double squared = dot(d, d);
  if (!(surplus > 0.0 && squared >= std::numeric_limits<double>::min())) return false;
  v -= (surplus / squared) * d;
  return true;
}

/// Limits the work or power of the wrench along the motion d, a to `most` (>= 0): J if d is a
/// displacement, W if it is a velocity. Reduces only parts along the motion. True if it did.
inline bool limit_surplus(Wrench& w, const Vec3& d, const Vec3& a, double most) RT_SAFE {
  const double pushed = std::fmax(dot(w.force_N, d), 0.0);
  const double turned = std::fmax(dot(w.torque_Nm, a), 0.0);
  if (!(pushed + turned > most)) return false;
  const double too_much = 1.0 - most / (pushed + turned);
  // F' = F - (1 - most / P) (F . d) d / |d|^2
  const bool taken = take_along(w.force_N, too_much * pushed, d);
  return take_along(w.torque_Nm, too_much * turned, a) || taken;
}

}  // namespace tact::firmware::gate
