// SPDX-License-Identifier: Apache-2.0
// phantom_session.h - a PHANTOM or a Touch, opened, with what its library tells of it.
//
// W is the device's frame with its axes renamed: x of W is z of the device, y is x, z is y. Its
// origin is the middle of the box in which the maker promises forces (HD-5). Set-up code only; tact
// locks its memory before, and the library's heap with it.
#pragma once

#include <string>

#include "hal/phantom/hd_library.h"
#include "model/device_settings.h"
#include "model/types.h"

namespace tact::hal::phantom {

struct PhantomSession {
  HdFunctions hd;
  HdDevice id = kHdNoDevice;
  std::string model, serial_number;  // empty: the library does not tell
  double max_force_N = 0.0, continuous_force_N = 0.0, max_stiffness_N_per_m = 0.0;
  model::Vec3 middle_m;  // origin of W, from the device's origin, along the axes of W
  double radius_m = 0.0, half_length_m = 0.0;  // of the cylinder within that box
  bool wrist = false;                          // it measures an orientation
  int calibration_styles = 0;
};

/// Its scheduler does not run yet. Leaves nothing open when it fails.
model::Result<PhantomSession> open_phantom_session(const model::PhantomSettings& settings,
                                                   bool trust_library);

/// What a person does for a device that has no calibration.
const char* calibration_cure(const PhantomSession& session);

/// The device's axes, renamed.
inline model::Vec3 to_w(const double of_device[3], double scale = 1.0) {
  return {scale * of_device[2], scale * of_device[0], scale * of_device[1]};
}

}  // namespace tact::hal::phantom
