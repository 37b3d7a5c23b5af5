// SPDX-License-Identifier: Apache-2.0
// stiffness_check.h - is the law stable on this device at this rate? Asked once, before the loop
// starts: a spring that is stiffer than both can render shakes the hand. It is refused, with what
// to change. Set-up code.
#pragma once

#include "hal/device.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::admission {

struct StiffnessMargin {
  double needed_N_per_m = 0.0;  // by all spheres together
  double limit_N_per_m = 0.0;   // of device, rate and the law's own damping (haptic_limit.h)
};

/// All spheres on the stiffest place at once, pressed and slid. The error says which key is too
/// stiff, or damps too much, and to what it must fall.
model::Result<StiffnessMargin> check_renderable(const model::scene::Scene& scene,
                                                const model::scene::Tissue& tissue,
                                                const hal::DeviceInfo& device);

}  // namespace tact::firmware::admission
