// SPDX-License-Identifier: Apache-2.0
// delta_frame.h - from a delta's own frame D to the hand's frame W and back.
//
//     W x = D z - middle,   W y = -D y,   W z = D x        the delta lies on its side
#pragma once

#include "model/types.h"

namespace tact::hal::delta {

using model::Vec3;

/// Directions: forces, velocities. The matrix is its own inverse, but the names say which way.
constexpr Vec3 direction_W(const Vec3& v_D) RT_SAFE { return {v_D.z, -v_D.y, v_D.x}; }
constexpr Vec3 direction_D(const Vec3& v_W) RT_SAFE { return {v_W.z, -v_W.y, v_W.x}; }
/// Points.
constexpr Vec3 point_W(const Vec3& p_D, double middle_m) RT_SAFE {
  return direction_W(p_D - Vec3{0.0, 0.0, middle_m});
}
constexpr Vec3 point_D(const Vec3& p_W, double middle_m) RT_SAFE {
  return direction_D(p_W) + Vec3{0.0, 0.0, middle_m};
}

}  // namespace tact::hal::delta
