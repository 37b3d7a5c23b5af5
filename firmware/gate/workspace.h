// SPDX-License-Identifier: Apache-2.0
// workspace.h - position and speed limits of the tool, outside of which the force ramps down.
//
// The workspace is a cylinder about the W x axis, centred on the origin. NaN exceeds every limit.
#pragma once

#include <cmath>

#include "firmware/gate/limiter.h"
#include "model/limits.h"
#include "model/types.h"

namespace tact::firmware::gate {

inline bool is_inside(const model::Limits& limits, const model::Vec3& p_m) RT_SAFE {
  return is_within({0.0, p_m.y, p_m.z}, limits.workspace_radius_m) &&
         std::abs(p_m.x) <= limits.workspace_half_length_m;
}

inline bool is_slow(const model::Limits& limits, const model::Tool& tool) RT_SAFE {
  return is_within(tool.velocity_mps, limits.speed_mps) &&
         is_within(tool.angular_velocity_radps, limits.turn_radps);
}

}  // namespace tact::firmware::gate
