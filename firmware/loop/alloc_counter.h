// SPDX-License-Identifier: Apache-2.0
// alloc_counter.h - counts what the loop must never do: heap calls of one thread.
//
// The program's malloc, calloc, realloc, aligned forms and free pass through here on their way to
// glibc (operator new ends in malloc). A thread that watches itself counts its own calls; others
// pay one test of a thread-local flag. Address and thread sanitizer of clang interpose the same
// names and call a hook of ours instead. Realtime sanitizer has none: there nothing is counted, and
// it ends the program itself at a heap call below an RT_SAFE function.
#pragma once

#include <cstdint>

namespace tact::firmware::loop {

/// False in builds where heap calls cannot be counted: realtime sanitizer, and gcc's sanitizers.
bool can_count_heap_calls();

/// Under any sanitizer, which makes system calls of its own, and more memory than is locked.
bool is_sanitized();

/// Counts the heap calls of this thread while it lives.
class HeapCallCounter {
 public:
  HeapCallCounter();
  ~HeapCallCounter();
  HeapCallCounter(const HeapCallCounter&) = delete;
  HeapCallCounter& operator=(const HeapCallCounter&) = delete;
  std::uint64_t calls() const;
};

}  // namespace tact::firmware::loop
