// SPDX-License-Identifier: Apache-2.0
// whole_file.h - a file's content in one piece.
#pragma once

#include <string>

#include "model/result.h"

namespace tact::tools::program {

/// All or nothing: a reader never sees half a file.
model::Result<std::string> write_whole_file(const std::string& path, const std::string& content);

/// What is missing is an error, what is empty is not.
model::Result<std::string> read_whole_file(const std::string& path);

}  // namespace tact::tools::program
