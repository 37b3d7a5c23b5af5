// SPDX-License-Identifier: Apache-2.0
// unattended.h - what tactd does not do when nobody is there to see it.
#pragma once

#include <optional>

#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::firmware::admission {

/// Homing on a jig believes that the arms rest there at this very moment. A service starts at boot,
/// and again after a crash, wherever the arms are: it is refused. Error: why, and the remedy.
std::optional<model::Error> why_not_unattended(const model::scene::Scene& scene, bool is_service);

}  // namespace tact::firmware::admission
