// SPDX-License-Identifier: Apache-2.0
// ring_taper.h - makes the profile of an indentation end at zero with zero slope.
#pragma once

#include <cmath>
#include <cstddef>

#include "model/rt.h"

namespace tact::model::law {

/// The taper of CL-4: 1 inside, 0 at the last ring, with zero slope at both ends.
inline double ring_taper(std::size_t ring, std::size_t rings) RT_SAFE {
  constexpr double kStart = 0.7;  // of the outermost radius
  const double x = static_cast<double>(ring) / static_cast<double>(rings);
  const double t = std::fmax(0.0, (x - kStart) / (1.0 - kStart));
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

}  // namespace tact::model::law
