// SPDX-License-Identifier: Apache-2.0
#include "model/io/nesting.h"

namespace tact::model::io {
namespace {

constexpr auto kEnd = std::string_view::npos;

/// Behind the string that begins at `at`; TOML has three quotes too, which hold lines.
std::size_t behind_string(std::string_view text, std::size_t at, bool is_toml) {
  const char quote = text[at];
  const std::string_view three = quote == '"' ? R"(""")" : "'''";
  const bool long_one = is_toml && text.substr(at, 3) == three;
  // TOML's single quotes take a backslash as it is.
  const bool escapes = quote == '"';
  for (at += long_one ? 3 : 1; at < text.size(); ++at) {
    if (escapes && text[at] == '\\') {
      ++at;
    } else if (long_one) {
      if (text.substr(at, 3) != three) continue;
      for (at += 3; at < text.size() && text[at] == quote; ++at) continue;  // up to two more
      return at;
    } else if (text[at] == quote) {
      return at + 1;
    } else if (text[at] == '\n') {
      return at;  // not closed: the parser says so
    }
  }
  return text.size();
}

/// May stand in a bare key of TOML, or between its parts.
bool is_of_key(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '+' || c == ' ' || c == '\t' || static_cast<unsigned char>(c) >= 0x80;
}

/// One pass without a stack: it must not itself end on what it
/// looks for. Lines are counted only for the answer.
std::optional<std::size_t> too_deep(std::string_view text, bool is_toml) {
  std::size_t depth = 0, dots = 0, line = 1, counted = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || (is_toml && c == '\'')) {
      at = behind_string(text, at, is_toml);
      continue;
    }
    if (is_toml && c == '#') {
      at = text.find('\n', at);
      if (at == kEnd) break;
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    // The parser reports too many closing ones.
    if ((c == ']' || c == '}') && depth > 0) --depth;
    // Dots add up over one key, blanks between its parts included.
    if (is_toml && c == '.')
      ++dots;
    else if (!is_of_key(c))
      dots = 0;
    if (depth + dots > kDeepest) {
      for (; counted < at; ++counted) line += text[counted] == '\n' ? 1 : 0;
      return line;
    }
    ++at;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::size_t> too_deep_json(std::string_view text) { return too_deep(text, false); }
std::optional<std::size_t> too_deep_toml(std::string_view text) { return too_deep(text, true); }

}  // namespace tact::model::io
