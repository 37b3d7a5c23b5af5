// SPDX-License-Identifier: Apache-2.0
// bus_wait.h - at boot a service may come before the bus of its device.
#pragma once

#include "firmware/console/operator_signals.h"
#include "model/scene/scene.h"

namespace tact::firmware::run {

/// Asks once a second, and says once for what it waits. False: a signal ended the wait.
bool wait_for_bus(const model::scene::Scene& scene, const console::OperatorSignals& signals);

}  // namespace tact::firmware::run
