// SPDX-License-Identifier: Apache-2.0
// hand_path.h - where a simulated hand wants to be: waypoints joined by minimum-jerk moves.
//
//     p(t) + R(t) c = p0 + R0 c + (p1 + R1 c - p0 - R0 c) u,   r(t) = r0 + (r1 - r0) u
//     u = 10 s^3 - 15 s^4 + 6 s^5,   s = (t - t0) / (t1 - t0)
//
//     p, r  position and rotation vector, R the rotation;  c  the point that goes straight
//
// [T. Flash, N. Hogan, J. Neurosci. 5 (1985) 1688]: zero speed and acceleration at each waypoint.
#pragma once

#include <vector>

#include "model/types.h"

namespace tact::model {

struct HandWaypoint {
  double time_s = 0.0;      // ascending; the first is 0
  Vec3 position_m;          // W
  Vec3 rotation_rad{};      // of the tool against its rest orientation, rotation vector in W
  double grip_ratio = 0.0;  // 0 open, 1 closed
  Vec3 straight_m{};        // what goes straight on the way here, tool frame
};

/// A hand holds the handle through a spring and a damper; its own mass moves with the handle.
struct HandSettings {
  double mass_kg = 0.0;
  double stiffness_N_per_m = 0.0;
  double damping_Ns_per_m = 0.0;
  bool repeat = false;             // start over after the last waypoint
  std::vector<HandWaypoint> path;  // at least one
};

/// Where the hand wants to be at a time since the start; holds the last waypoint afterwards.
HandWaypoint hand_target(const std::vector<HandWaypoint>& path, bool repeat, double time_s) RT_SAFE;

}  // namespace tact::model
