// SPDX-License-Identifier: Apache-2.0
// ask.h - a program beside this one, asked: what it prints is the answer.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"

namespace tact::tools::new_scene {

/// The lines that `program` has printed. If it fails, an error that is its own last line.
model::Result<std::vector<std::string>> ask(const char* program,
                                            const std::vector<std::string>& arguments,
                                            const std::string& log_path);

}  // namespace tact::tools::new_scene
