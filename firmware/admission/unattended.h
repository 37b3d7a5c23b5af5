// SPDX-License-Identifier: Apache-2.0
// unattended.h - what tactd refuses when it runs as a service, without an operator.
#pragma once

#include <optional>

#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::firmware::admission {

/// Homing on a jig assumes that the arms rest on it at the start. A service starts at boot and
/// after a crash, with the arms anywhere, so it is refused. Error: the reason and the remedy.
std::optional<model::Error> why_not_unattended(const model::scene::Scene& scene, bool is_service);

}  // namespace tact::firmware::admission
