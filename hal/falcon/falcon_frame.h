// SPDX-License-Identifier: Apache-2.0
// falcon_frame.h - where frame W lies in a Falcon, and how much of it the device may use.
//
//     W x = device z - 0.120 m (towards the user),   W y = device x (right),   W z = device y (up)
//
// 0.120 m is the middle of the reach on the axis, 0.060 to 0.183 m (FK-6). Within 40 mm of it every
// pose is reachable and its transmission stays within a factor of 4.3. CHAI3D has the same radius
// and 8 N: github.com/chai3d/chai3d, src/devices/CDeltaDevices.cpp.
#pragma once

#include "model/types.h"

namespace tact::hal::falcon {

using model::Vec3;

inline constexpr double kFalconMiddle_m = 0.120;
inline constexpr double kFalconRadius_m = 0.040;
inline constexpr double kFalconHalfLength_m = 0.040;  // along W x
inline constexpr double kFalconMaxForce_N = 8.0;

constexpr Vec3 falcon_point_W(const Vec3& p_D) RT_SAFE {
  return {p_D.z - kFalconMiddle_m, p_D.x, p_D.y};
}
constexpr Vec3 falcon_point_D(const Vec3& p_W) RT_SAFE {
  return {p_W.y, p_W.z, p_W.x + kFalconMiddle_m};
}
constexpr Vec3 falcon_direction_D(const Vec3& v_W) RT_SAFE { return {v_W.y, v_W.z, v_W.x}; }

}  // namespace tact::hal::falcon
