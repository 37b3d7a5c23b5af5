// SPDX-License-Identifier: Apache-2.0
// saturation.h - a vector no longer than the hardware can make, along the one that was asked for:
//
//     v min(1, most / |v|)
#pragma once

#include <limits>

#include "model/rt.h"
#include "model/types.h"

namespace tact::hal {

/// v, or the vector of this length along it; zero for a v that is infinite or no number.
inline model::Vec3 saturated(const model::Vec3& v, double most) RT_SAFE {
  const double size = norm(v);
  if (size <= most) return v;
  return size < std::numeric_limits<double>::infinity() ? v * (most / size) : model::Vec3{};
}

}  // namespace tact::hal
