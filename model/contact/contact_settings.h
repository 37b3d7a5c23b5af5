// SPDX-License-Identifier: Apache-2.0
// contact_settings.h - settings of contact in a scene: probe spheres of the tool, friction, grip.
#pragma once

#include <cstddef>

#include "model/types.h"

namespace tact::model::contact {

inline constexpr std::size_t kMaxSpheres = 16;  // of one tool

struct ProbeSphere {
  Vec3 offset_m;          // from the tool's origin, tool frame
  double radius_m = 0.0;  // > 0
};

struct ContactParameters {
  double friction_ratio = 0.0;             // mu, >= 0
  double sliding_stiffness_N_per_m = 0.0;  // 1 / G, >= 0; 0: from the law
  double tear_force_N = 0.0;               // of one sphere, > 0
  double grip_close_ratio = 0.7;           // the grip holds from this ratio on
  double grip_open_ratio = 0.5;            // the grip releases below this ratio
};

}  // namespace tact::model::contact
