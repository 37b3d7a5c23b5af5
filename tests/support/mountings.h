// SPDX-License-Identifier: Apache-2.0
// mountings.h - six ways to mount the base of a delta, and where down is for each.
#pragma once

#include <array>

#include "model/device_settings.h"

namespace tact::tests {

struct MountingCase {
  model::Vec3 orientation_deg;
  model::Vec3 down_B;  // unit, in the axes of the base
  const char* words;
};

inline constexpr std::array<MountingCase, 6> kMountings{
    {{{0, 0, 0}, {0, 0, -1}, "lies on its side, its axis points towards you"},
     {{0, 90, 0}, {1, 0, 0}, "hangs from above, its axis points down"},
     {{0, -90, 0}, {-1, 0, 0}, "is upright, its axis points up"},
     {{0, 0, 90}, {0, 0, -1}, "lies on its side, its axis points to the right"},
     {{90, 0, 0}, {0, -1, 0}, "lies on its side, its axis points towards you"},
     {{180, 0, 0}, {0, 0, 1}, "lies on its side, its axis points towards you"}}};

inline model::DeviceSettings settings_of(const MountingCase& one) {
  model::DeviceSettings settings;
  settings.base_orientation_deg = one.orientation_deg;
  return settings;
}

}  // namespace tact::tests
