// SPDX-License-Identifier: Apache-2.0
// script.h - work that a Python script does in the place of a program.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"

namespace tact::tools::program {

/// Debian's python3 with a script of share/tact, or of the folder of this program, takes our place,
/// and so our output, Ctrl-C and exit status. It comes back only if that fails. `package`: what
/// has the script.
model::Error become_script(const std::string& script, std::vector<std::string> arguments,
                           const std::string& package);

}  // namespace tact::tools::program
