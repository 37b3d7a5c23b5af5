// SPDX-License-Identifier: Apache-2.0
#include "model/io/one_line.h"

#include <algorithm>
#include <cstddef>

namespace tact::model::io {

std::string on_one_line(std::string_view text) {
  std::size_t end = std::min<std::size_t>(text.size(), 80);
  const auto inside_a_character = [&](char c) {
    return (static_cast<unsigned>(c) & 0xC0u) == 0x80u;
  };
  while (end > 0 && end < text.size() && inside_a_character(text[end])) --end;  // UTF-8 stays whole
  std::string line{text.substr(0, end)};
  for (char& c : line)
    if (is_control(c)) c = ' ';
  return end < text.size() ? line + "..." : line;
}

}  // namespace tact::model::io
