// SPDX-License-Identifier: Apache-2.0
// extent.h - how many of its random sequences does a test play?
//
// A tenth, for who waits for the answer. TACT_EXTENT=whole plays all of them, as tools/check --all
// and the mutations do; TACT_EXTENT=long what takes hours.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace tact::tests {

inline bool extent_is(std::string_view name) {
  const char* extent = std::getenv("TACT_EXTENT");
  return extent != nullptr && extent == name;
}

/// Of `whole` sequences, of which a long run plays `longest`.
inline std::uint64_t share_of(std::uint64_t whole, std::uint64_t longest) {
  if (extent_is("long")) return longest;
  return extent_is("whole") ? whole : std::max<std::uint64_t>(whole / 10, 1);
}

}  // namespace tact::tests
