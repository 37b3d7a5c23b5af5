// SPDX-License-Identifier: Apache-2.0
// limiter.h - what every stage of the gate does to a vector: shorten it, hold it back, take from it
// along a motion.
//
//     magnitude   |F| <= limit                             direction kept
//     approach    |F - F_before| <= step, |F| <= radius    or `shrink` nearer to radius than before
//     surplus     F . d + T . a <= most                    least change of each, along its motion
//
// Approach first reduces the magnitude, then uses the remaining slew for the direction: on a
// straight line to the goal the magnitude would fall more slowly than the slew allows. After ticks
// that were skipped `shrink` is the step of all the time that passed: a force catches up when it
// gets smaller, never when it grows or turns. Guards are written so that NaN falls to zero.
#pragma once

#include <limits>

#include "model/types.h"

namespace tact::firmware::gate {

using model::Vec3;
using model::Wrench;

/// |v| <= limit, without a root where the squares tell: sqrt(fl(limit^2)) is limit, so they agree.
inline bool is_within(const Vec3& v, double limit) RT_SAFE {
  return (limit >= 0.0 && dot(v, v) <= limit * limit) || norm(v) <= limit;
}

/// True if it had to shorten v.
inline bool limit_magnitude(Vec3& v, double limit) RT_SAFE {
  if (is_within(v, limit)) return false;
  const double length = norm(v);
  // Rounding cannot leave |v| above the limit. With u = 2^-53 a norm is off by 2.5 u at most: 3 u
  // of its square, halved by the root, and the root's own. Two norms and three operations: 8 u,
  // less than the room of 9 u. Above kNothing what underflows in a square is far below u.
  constexpr double kRoundingRoom = 1.0 - 1e-15;
  constexpr double kNothing = 1e-150;  // below it a square is a denormal, and a norm a guess
  v = length > 0.0 && limit > kNothing ? (kRoundingRoom * limit / length) * v : Vec3{};
  if (!is_finite(v)) v = {};
  return true;
}

/// One tick from `before` towards v. True if v was out of reach. `shrink` >= `step`.
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
    limit_magnitude(v, reach);  // by an ulp
    held = true;
  }
  return held;
}

/// Takes so much of v . d from v, along d. A motion whose square is a denormal is none: what is
/// divided by it is a guess, or no number.
inline bool take_along(Vec3& v, double surplus, const Vec3& d) RT_SAFE {
  const double squared = dot(d, d);
  if (!(surplus > 0.0 && squared >= std::numeric_limits<double>::min())) return false;
  v -= (surplus / squared) * d;
  return true;
}

/// True if the wrench did more than `most` (>= 0) along the motion d, a: J for a displacement, W
/// for a velocity. Only what pushes along the motion is made less; neither vector grows.
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
