// SPDX-License-Identifier: Apache-2.0
// say.h - messages to a terminal or pipe that may be gone: what cannot be said is no reason to
// end.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace tact::firmware::console {

/// As fmt::print, but a write that fails is ignored; fmt's throws, which would end a process whose
/// loop pushes.
template <typename... T>
void say(std::FILE* out, fmt::format_string<T...> message, T&&... words) {
  std::fputs(fmt::format(message, std::forward<T>(words)...).c_str(), out);
}

}  // namespace tact::firmware::console
