// SPDX-License-Identifier: Apache-2.0
// counters.h - clang's coverage, switched on for a part of the run.
//
// The counters themselves never stop, so what they were at pause() comes back at resume().
#pragma once

#include <algorithm>
#include <vector>

extern "C" {
char* __llvm_profile_begin_counters(void);
char* __llvm_profile_end_counters(void);
}

namespace tact::tick_reach::counters {

// Of the counted parts so far; at the beginning that is nothing.
inline std::vector<char> kept(static_cast<std::size_t>(__llvm_profile_end_counters() -
                                                       __llvm_profile_begin_counters()));

inline void pause() {
  std::copy(__llvm_profile_begin_counters(), __llvm_profile_end_counters(), kept.begin());
}
inline void resume() { std::copy(kept.begin(), kept.end(), __llvm_profile_begin_counters()); }
/// Before the process ends: what it then writes is of the counted parts alone.
inline void keep_only_counted() { resume(); }

}  // namespace tact::tick_reach::counters
