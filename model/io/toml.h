// SPDX-License-Identifier: Apache-2.0
// toml.h - the one reader of TOML: errors as messages with file and line, no text too deep for it.
#pragma once

#include <toml++/toml.h>

#include <string_view>

#include "model/result.h"

namespace tact::model::io {

/// `source` names the text in errors and in the nodes.
Result<toml::table> parse_toml(std::string_view text, std::string_view source);

}  // namespace tact::model::io
