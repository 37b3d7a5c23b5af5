// SPDX-License-Identifier: Apache-2.0
// probe_sphere.h - a sphere with which a tool touches.
#pragma once

#include "model/types.h"

namespace tact::model::contact {

struct ProbeSphere {
  Vec3 offset_m;          // from the tool's origin, tool frame
  double radius_m = 0.0;  // > 0
};

}  // namespace tact::model::contact
