// SPDX-License-Identifier: Apache-2.0
// stiffness_check.h - is the law stable on this device at this rate? Checked once, before the loop:
// a law stiffer than device and rate can render oscillates in the hand. It is refused, with a
// remedy. First the law's own numbers are checked, then presses of the whole tool into the organ.
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

/// K of HL-1, N/m, from the device, the rate and the damping of all spheres together. 0: the device
/// does not report its damping.
double stiffness_limit_N_per_m(const model::scene::Scene& scene, const model::scene::TissueLaw& law,
                               const hal::DeviceInfo& device);

/// Assumes all spheres on the stiffest point at once, pressed and slid. The error names the key
/// that is too stiff or damps too much, and the value to which it must fall.
model::Result<StiffnessMargin> check_renderable(const model::scene::Scene& scene,
                                                const model::scene::Tissue& tissue,
                                                const hal::DeviceInfo& device);

/// Result of sample presses of the whole tool (model/scene/press.h).
struct PressCheck {
  double slope_N_per_m = 0.0;  // the largest dF/dd
  std::string place{};         // where it occurs: "vertex 1586, upright"
  std::size_t presses = 0;
  std::string note{};  // a place where the force has a flaw, and the remedy; or empty
};

/// Presses upright at the vertex nearest to hand.site_m, and at a fixed sample of other vertices
/// in both directions; a stepped law only at the first. A slope above the limit at the hand's
/// vertex is an error, elsewhere a note. Takes 0.1 to 0.2 s, before the loop uses the tissue.
model::Result<PressCheck> check_presses(const model::scene::Scene& scene,
                                        const model::scene::Tissue& tissue,
                                        const hal::DeviceInfo& device, double limit_N_per_m);
/// The same check of a finished sweep, whose first place is the hand's.
model::Result<PressCheck> check_sweep(const model::scene::Scene& scene,
                                      const model::scene::TissueLaw& law,
                                      const hal::DeviceInfo& device,
                                      const model::scene::PressSweep& sweep);

}  // namespace tact::firmware::admission
