// SPDX-License-Identifier: Apache-2.0
// thermal_check.h - do the motors of this device bear what the scene allows?
#pragma once

#include <optional>

#include "model/limits.h"
#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::firmware::admission {

/// `limits`: as they hold on the device (gate/limits_for.h), whose motors may bear less for long
/// than the scene says. Error: its thermal time is too short for that, and the remedy.
std::optional<model::Error> check_thermal(const model::scene::Scene& scene,
                                          const model::Limits& limits);

}  // namespace tact::firmware::admission
