// SPDX-License-Identifier: Apache-2.0
// refusals.h - scenes that tactd refuses for this device or for the way it was started.
#pragma once

#include <optional>

#include "model/limits.h"
#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::firmware::admission {

/// Can the motors of this device sustain what the scene allows? `limits`: as applied on the device
/// (gate/limits_for.h); its continuous force may be lower than the scene's. The error says that the
/// thermal time is too short for it, with the remedy.
std::optional<model::Error> check_thermal(const model::scene::Scene& scene,
                                          const model::Limits& limits);

/// Homing on a jig assumes that the arms rest on it at the start. A service starts at boot and
/// after a crash, with the arms anywhere, so it is refused. Error: the reason and the remedy.
std::optional<model::Error> why_not_unattended(const model::scene::Scene& scene, bool is_service);

}  // namespace tact::firmware::admission
