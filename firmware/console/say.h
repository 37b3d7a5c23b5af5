// SPDX-License-Identifier: Apache-2.0
// say.h - prints to a terminal or pipe that may be gone; a failed write is ignored.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace tact::firmware::console {

/// As fmt::print, which however throws on a failed write; that would end a process whose loop
/// renders force.
template <typename... T>
void say(std::FILE* out, fmt::format_string<T...> message, T&&... words) {
  std::fputs(fmt::format(message, std::forward<T>(words)...).c_str(), out);
}

}  // namespace tact::firmware::console
