// SPDX-License-Identifier: Apache-2.0
// stiffness_check.h - is the law stable on this device at this rate? Asked once, before the loop
// starts: a spring that is stiffer than both can render shakes the hand. It is refused, with what
// to change. First by the numbers of the law, then by pressing the whole tool into the organ.
// Set-up code.
#pragma once

#include <cstddef>
#include <string>

#include "hal/device.h"
#include "model/result.h"
#include "model/scene/press_sweep.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::admission {

struct StiffnessMargin {
  double needed_N_per_m = 0.0;  // by all spheres together
  double limit_N_per_m = 0.0;   // of device, rate and the law's own damping (haptic_limit.h)
};

/// K of HL-1, N/m: device, rate, and the damping of all spheres at once. 0: the device does not
/// tell what it can bear.
double stiffness_limit_N_per_m(const model::scene::Scene& scene, const model::scene::TissueLaw& law,
                               const hal::DeviceInfo& device);

/// All spheres on the stiffest place at once, pressed and slid. The error says which key is too
/// stiff, or damps too much, and to what it must fall.
model::Result<StiffnessMargin> check_renderable(const model::scene::Scene& scene,
                                                const model::scene::Tissue& tissue,
                                                const hal::DeviceInfo& device);

/// What a sample of presses of the whole tool showed (model/scene/press.h).
struct PressCheck {
  double slope_N_per_m = 0.0;  // the largest dF/dd
  std::string place{};         // of it: "vertex 1586, upright"
  std::size_t presses = 0;
  std::string note{};  // for people: a place where the force is not sound, and the remedy; or empty
};

/// At the vertex nearest to hand.site_m, upright, and at a few others both ways, the same ones each
/// time; of a stepped law at the first alone. A slope above the limit is refused where the hand
/// presses; elsewhere it is in the note. On a tissue of its own; 0.1 to 0.2 s.
model::Result<PressCheck> check_presses(const model::scene::Scene& scene,
                                        const model::scene::TissueLaw& law,
                                        const hal::DeviceInfo& device, double limit_N_per_m);
/// The same of a sweep whose first place is the hand's.
model::Result<PressCheck> check_sweep(const model::scene::Scene& scene,
                                      const model::scene::TissueLaw& law,
                                      const hal::DeviceInfo& device,
                                      const model::scene::PressSweep& sweep);

}  // namespace tact::firmware::admission
