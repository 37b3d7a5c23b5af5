// SPDX-License-Identifier: Apache-2.0
// nesting.h - how deep text is nested, before a parser that calls itself reads it.
//
// toml++ and nlohmann::json take a stack frame or more a level, when they parse or when they forget
// what they parsed: 400 000 brackets end the process. No file of tact needs more than a few levels.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace tact::model::io {

inline constexpr std::size_t kDeepest = 64;

/// The first line, from 1, whose brackets are deeper than kDeepest; empty: none is.
std::optional<std::size_t> too_deep_json(std::string_view text);
/// Brackets, and keys of many parts as in a.b.c.
std::optional<std::size_t> too_deep_toml(std::string_view text);

}  // namespace tact::model::io
