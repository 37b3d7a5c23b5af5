// SPDX-License-Identifier: Apache-2.0
// start_text.h - what tactd says of scene and device before its loop runs.
#pragma once

#include <string>
#include <vector>

#include "firmware/console/operator_signals.h"
#include "firmware/run/loop_parts.h"
#include "model/scene/scene.h"

namespace tact::firmware::run {

/// What a person should know, though it hinders nothing; with --check also what takes long to find.
std::vector<std::string> start_notes(const model::scene::Scene& scene, const LoopParts& parts,
                                     bool is_check);
/// At boot a service may come before the bus of its device. Asks once a second, and says once for
/// what it waits. False: a signal ended the wait.
bool wait_for_bus(const model::scene::Scene& scene, const console::OperatorSignals& signals);
/// What --check found, in a few lines.
std::string check_lines(const model::scene::Scene& scene, const LoopParts& parts);

}  // namespace tact::firmware::run
