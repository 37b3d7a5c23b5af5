// SPDX-License-Identifier: Apache-2.0
// ring_taper.h - how the profile of an indentation ends: at zero, with zero slope, or at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "model/rt.h"

namespace tact::model::law {

/// The taper of CL-4: 1 inside, 0 at the last ring, with zero slope at both ends.
inline double ring_taper(std::size_t ring, std::size_t rings) RT_SAFE {
  constexpr double kTaperStart_ratio = 0.7;  // of the outermost radius
  const double x = static_cast<double>(ring) / static_cast<double>(rings);
  const double t = std::fmax(0.0, (x - kTaperStart_ratio) / (1.0 - kTaperStart_ratio));
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

/// The profile of a law that models the touched point alone: u_0 = d, u_1 = 0; nothing in pull.
inline std::size_t lone_profile(double depth_m, std::span<double> ring_m) RT_SAFE {
  const std::array<double, 2> u_m{std::fmax(depth_m, 0.0), 0.0};
  const std::size_t count = std::min(u_m.size(), ring_m.size());
  std::copy_n(u_m.begin(), count, ring_m.begin());
  return count;
}

}  // namespace tact::model::law
