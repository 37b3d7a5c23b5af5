// SPDX-License-Identifier: Apache-2.0
// html.h - what every page of a tool does alike.
#pragma once

#include <string>

namespace tact::tools::report {

/// Text that HTML would read as its own, made plain.
std::string escape_html(const std::string& text);

}  // namespace tact::tools::report
