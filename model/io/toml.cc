// SPDX-License-Identifier: Apache-2.0
#include "model/io/toml.h"

#include <fmt/format.h>

#include "model/io/nesting.h"
#include "model/io/one_line.h"

namespace tact::model::io {

Result<toml::table> parse_toml(std::string_view text, std::string_view source) {
  if (const auto line = too_deep_toml(text))
    return Error{fmt::format("{}:{}: nested deeper than {} levels; write it flatter", source, *line,
                             kDeepest)};
  try {  // the library reports by exceptions; they end here
    return toml::table{toml::parse(text, source)};
  } catch (const toml::parse_error& wrong) {
    return Error{fmt::format("{}:{}: not TOML: {}; correct this line, or quote text that has signs",
                             source, wrong.source().begin.line, on_one_line(wrong.description()))};
  }
}

}  // namespace tact::model::io
