// limiter.h - magnitude and slew of one vector: force or torque.
//
//     magnitude   |F| <= limit                   direction kept
//     slew        |F - F_before| <= step         moves straight towards the wanted vector
//
// Guards are written so that NaN falls to zero.
#pragma once

#include "model/types.h"

namespace tact::firmware {

using model::Vec3;

/// True if it had to shorten v.
inline bool limit_magnitude(Vec3& v, double limit) RT_SAFE {
  const double length = norm(v);
  if (length <= limit) return false;
  // Scaled down a hair more than needed, so that rounding cannot leave |v| above the limit.
  constexpr double kRoundingRoom = 1.0 - 4e-16;
  v = length > 0.0 ? (kRoundingRoom * limit / length) * v : Vec3{};
  if (!is_finite(v)) v = {};
  return true;
}

/// True if it had to hold v back.
inline bool limit_slew(Vec3& v, const Vec3& before, double step) RT_SAFE {
  Vec3 change = v - before;
  if (!limit_magnitude(change, step)) return false;
  v = before + change;
  return true;
}

}  // namespace tact::firmware
