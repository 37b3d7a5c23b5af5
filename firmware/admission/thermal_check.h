// SPDX-License-Identifier: Apache-2.0
// thermal_check.h - can the motors of this device sustain what the scene allows?
#pragma once

#include <optional>

#include "model/limits.h"
#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::firmware::admission {

/// `limits`: as applied on the device (gate/limits_for.h); its continuous force may be lower than
/// the scene's. The error says that the thermal time is too short for it, with the remedy.
std::optional<model::Error> check_thermal(const model::scene::Scene& scene,
                                          const model::Limits& limits);

}  // namespace tact::firmware::admission
