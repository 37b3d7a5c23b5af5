// SPDX-License-Identifier: Apache-2.0
// mounting.h - the pose of a device's base in the room, and how its motion is scaled.
//
//     p_W = s R p_B + t    v_W = s R v_B    F_B = s R^T F_W    T_B = R^T T_W    g_B = R^T g_W
//
//     B  the frame W of a base that lies on its side, its axis x towards the operator
//     R  device.base_orientation_deg: turn of the base, axis times angle
//     t  device.base_position_m: where the origin of B is in W, m
//     s  device.motion_scale: way of the tool for a way of the handle
//
// Power agrees: F_B . v_B = F_W . v_W. This is the one place that turns what a device reports and
// receives; the weight balance asks it where down is.
#pragma once

#include <string>

#include "hal/device.h"
#include "model/device_settings.h"
#include "model/types.h"

namespace tact::hal {

struct Mounting {
  model::Quat turn;  // R
  Vec3 shift_m;      // t
  double scale = 1.0;

  Vec3 point_W(const Vec3& in_base_m) const RT_SAFE {
    return scale * rotate(turn, in_base_m) + shift_m;
  }
  Vec3 point_in_base(const Vec3& p_W) const RT_SAFE {
    return rotate(conjugate(turn), p_W - shift_m) / scale;
  }
  Vec3 velocity_W(const Vec3& in_base_mps) const RT_SAFE {
    return scale * rotate(turn, in_base_mps);
  }
  Vec3 velocity_in_base(const Vec3& v_W) const RT_SAFE {
    return rotate(conjugate(turn), v_W) / scale;
  }
  Vec3 force_in_base(const Vec3& f_W) const RT_SAFE { return scale * rotate(conjugate(turn), f_W); }
  /// A direction without a size in m or N: an axis, an angular velocity, a torque.
  Vec3 direction_W(const Vec3& in_base) const RT_SAFE { return rotate(turn, in_base); }
  Vec3 direction_in_base(const Vec3& d_W) const RT_SAFE { return rotate(conjugate(turn), d_W); }
  /// g_B: where down is for the base.
  Vec3 gravity_in_base_mps2() const RT_SAFE;

  friend bool operator==(const Mounting&, const Mounting&) = default;
};

Mounting mounting_of(const model::DeviceSettings& settings);

/// "the base hangs from above, its axis points down; down is (1, 0, 0) in its own axes".
std::string text_of(const Mounting& mounting);

/// What a device that is mounted so can do, in W. Its workspace is the largest cylinder about x of
/// W around the origin, in the proportions of the device's own, that the device surely reaches.
DeviceInfo mounted(DeviceInfo info, const Mounting& mounting);

}  // namespace tact::hal
