// SPDX-License-Identifier: Apache-2.0
// command_line.h - what every program's command line does alike: one-line errors, --version.
#pragma once

#include <functional>
#include <optional>

#include "model/result.h"

namespace CLI {
class App;
}

namespace tact::model::io {

/// Version of tact, as CMakeLists.txt has it.
const char* tact_version();
/// Revision of the sources, as git describes it; "unknown" where the build had no git.
const char* source_revision();
/// Version of the compiler that built this.
const char* compiler_version();

/// Adds --version, and parses. A bad option is reported on standard error, in one line that names
/// --help. The exit status when the program ends here: 0 after --version or --help, 2 otherwise.
/// `check` looks at what no single option can know, such as two that contradict each other; its
/// error is reported in the same way.
std::optional<int> parse_command_line(CLI::App& options, const char* program, int argc,
                                      const char* const* argv,
                                      const std::function<std::optional<Error>()>& check = {});

}  // namespace tact::model::io
