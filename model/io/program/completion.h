// SPDX-License-Identifier: Apache-2.0
// completion.h - what bash needs to complete a program's options, made from the options themselves.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace tact::model::io {

/// A script for share/bash-completion/completions: options and subcommands, the values of an option
/// that has a list of them, files for all else.
std::string bash_completion(const CLI::App& options, const std::string& program);

}  // namespace tact::model::io
