// SPDX-License-Identifier: Apache-2.0
// start_text.h - texts about scene and device that tactd prints before its loop runs.
#pragma once

#include <string>
#include <vector>

#include "firmware/console/operator_signals.h"
#include "firmware/run/loop_parts.h"
#include "model/scene/scene.h"

namespace tact::firmware::run {

/// Notes that do not prevent a run; with --check also those that take long to compute.
std::vector<std::string> start_notes(const model::scene::Scene& scene, const LoopParts& parts,
                                     bool is_check);
/// At boot a service may start before the bus of its device is up. Polls once a second, and reports
/// once what it waits for. False: a signal ended the wait.
bool wait_for_bus(const model::scene::Scene& scene, const console::OperatorSignals& signals);
/// The results of --check, in a few lines.
std::string check_lines(const model::scene::Scene& scene, const LoopParts& parts);

}  // namespace tact::firmware::run
