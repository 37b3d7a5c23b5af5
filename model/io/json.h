// SPDX-License-Identifier: Apache-2.0
// json.h - the one reader and writer of JSON: errors as messages with their place, no text that is
// too deep to read, none that cannot be written.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "model/io/input_file.h"
#include "model/io/nesting.h"
#include "model/io/one_line.h"
#include "model/result.h"

namespace tact::model::io {

/// `source` names the text in errors. Json may be nlohmann::ordered_json.
template <typename Json = nlohmann::json>
Result<Json> parse_json(std::string_view text, std::string_view source) {
  if (const auto line = too_deep_json(text))
    return Error{fmt::format("{}:{}: nested deeper than {} levels", source, *line, kDeepest)};
  try {  // the library reports by exceptions; they end here
    return Json::parse(text.begin(), text.end());
  } catch (const typename Json::exception& wrong) {
    const std::string_view what = wrong.what();  // "[json.exception...] parse error at line 1, ..."
    const std::size_t word = what.find("] ");
    return Error{fmt::format("{}: not JSON: {}", source,
                             on_one_line(word == what.npos ? what : what.substr(word + 2)))};
  }
}

template <typename Json = nlohmann::json>
Result<Json> read_json(const std::string& path, std::string_view remedy = "check the name") {
  const auto text = read_file(path, remedy);
  if (!text) return text.error();
  auto json = parse_json<Json>(*text, path);
  if (!json) return Error{fmt::format("{}; {}", json.error().message, remedy)};
  return json;
}

/// Bytes that are no UTF-8, as a path or the name of a device may have, become U+FFFD.
template <typename Json>
std::string text_of(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tact::model::io
