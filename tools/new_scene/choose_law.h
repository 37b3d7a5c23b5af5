// SPDX-License-Identifier: Apache-2.0
// choose_law.h - the law of a new scene, by asking the programs beside this one: references by
// tact-lab reference, then tact-lab plan, which leaves its choice in this user's cache for this PC.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/result.h"
#include "tools/new_scene/outputs.h"

namespace tact::tools::new_scene {

/// The lines that `program` has printed. If it fails, an error that is its own last line.
model::Result<std::vector<std::string>> ask(const char* program,
                                            const std::vector<std::string>& arguments,
                                            const std::string& log_path);

/// `files.scene` says law = "auto"; files.reference and files.tool_reference are written, tactd
/// takes the scene with the law that was chosen. An error says why none was: CalculiX is missing,
/// no law could be measured, Ctrl-C. Minutes to an hour.
std::optional<model::Error> choose_law(
    const OutputNames& files, const std::string& log_path,
    const std::function<void(const char* step, const std::string& text)>& report);

}  // namespace tact::tools::new_scene
