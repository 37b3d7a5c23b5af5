// SPDX-License-Identifier: Apache-2.0
// device_joints.h - how the joint angles of a device follow from the position of its handle.
//
//     p_D = M p_W + o,    v_D = M v_W
//
//     p_W  handle in frame W, m: without the shift of the clutch
//     p_D  the same in the device's own frame, for which its inverse kinematics are written
#pragma once

#include <array>
#include <string>

namespace tact::model {

struct DeviceJoints {
  std::string linkage;  // "delta" (hal/delta), "falcon" (hal/falcon); empty: no joints are known
  double base_radius_m = 0.0, platform_radius_m = 0.0;  // of a delta; a falcon has one geometry
  double upper_arm_m = 0.0, forearm_m = 0.0;
  std::array<double, 3> azimuth_rad{};
  std::array<std::array<double, 3>, 3> row{};  // of M
  std::array<double, 3> origin_m{};            // o
};

}  // namespace tact::model
