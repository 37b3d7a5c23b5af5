// SPDX-License-Identifier: Apache-2.0
// one_line.h - text of a stranger inside a message of ours.
#pragma once

#include <string>
#include <string_view>

namespace tact::model::io {

/// Nothing that belongs in a line of text: a break, a bell, an escape.
constexpr bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// One line of printable text, at most 80 characters, for any input: for values in messages.
std::string on_one_line(std::string_view text);

}  // namespace tact::model::io
