// SPDX-License-Identifier: Apache-2.0
// phantom_session.h - a PHANTOM or a Touch, opened, with what its library reports of it.
//
// W is the device's frame with its axes renamed (kAxisOfDevice). Its origin is the middle of the
// box in which the vendor promises forces (HD-5). Set-up code only; tact
// locks its memory before, and the library's heap with it.
#pragma once

#include <string>

#include "hal/permission.h"
#include "hal/phantom/hd_library.h"
#include "hal/phantom/phantom_device.h"
#include "model/types.h"

namespace tact::hal::phantom {

struct PhantomSession {
  HdFunctions hd;
  HdDevice id = kHdNoDevice;
  std::string model, serial_number;  // empty: the library does not report it
  double max_force_N = 0.0;
  double continuous_force_N = 0.0, max_stiffness_N_per_m = 0.0;  // 0: it does not report it
  model::Vec3 middle_m;  // origin of W, from the device's origin, along the axes of W
  double radius_m = 0.0, half_length_m = 0.0;  // of the cylinder within that box
  bool wrist = false;                          // it measures an orientation
  int calibration_styles = 0;
};

/// Its scheduler does not run yet. Leaves nothing open when it fails.
model::Result<PhantomSession> open_phantom_session(const PhantomSettings& settings,
                                                   bool trust_library,
                                                   const SystemRoots& roots = {});

/// What a person does for a device that has no calibration.
const char* calibration_remedy(const PhantomSession& session);

/// Which axis of the device is x, y, z of W.
inline constexpr int kAxisOfDevice[3] = {2, 0, 1};

inline model::Vec3 to_w(const double of_device[3], double scale = 1.0) {
  const auto& [x, y, z] = kAxisOfDevice;
  return {scale * of_device[x], scale * of_device[y], scale * of_device[z]};
}
inline void to_device(const model::Vec3& of_w, double (&of_device)[3]) {
  const auto& [x, y, z] = kAxisOfDevice;
  of_device[x] = of_w.x, of_device[y] = of_w.y, of_device[z] = of_w.z;
}

}  // namespace tact::hal::phantom
