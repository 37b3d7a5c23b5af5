// law_check.h - may this law be felt here? Asked once, before the loop starts.
//
// A spring that is stiffer than device and rate can render starts to shake the hand, and a law that
// takes longer than its share of the tick makes the loop late: both are refused, with what to
// change. Set-up code.
#pragma once

#include <optional>

#include "hal/device.h"
#include "model/scene.h"
#include "model/tissue.h"

namespace tact::firmware {

/// All spheres on the stiffest place at once, pressed and slid, against haptic_limit.h.
std::optional<model::Error> check_renderable(const model::Scene& scene, const model::Tissue& tissue,
                                             const hal::DeviceInfo& device);

/// Median time of a law's share of a tick on this machine, us, all spheres pressed. What it presses
/// is forgotten: a law that remembers must be measured on a twin, not on the one that will be felt.
double measure_law_us(const model::Scene& scene, const model::TissueLaw& twin);

/// A twin's measure_law_us against [tolerance] tick_budget_us; nothing to say without one.
std::optional<model::Error> check_budget(const model::Scene& scene);

/// Both, the device first.
std::optional<model::Error> check_law(const model::Scene& scene, const model::Tissue& tissue,
                                      const hal::DeviceInfo& device);

}  // namespace tact::firmware
