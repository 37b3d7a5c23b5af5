// SPDX-License-Identifier: Apache-2.0
// alloc_counter.h - counts the heap calls of a thread; the loop's thread must make none.
//
// malloc, calloc, realloc, aligned forms and free are replaced by wrappers that count and then call
// glibc (operator new calls malloc). A thread counts while it has a HeapCallCounter; other threads
// only test a thread-local flag. The address and thread sanitizers of clang replace the same
// functions and call our hook instead. The realtime sanitizer has no hook: nothing is counted, and
// it ends the program itself at a heap call below an RT_SAFE function.
#pragma once

#include <cstdint>

namespace tact::firmware::loop {

/// False in builds where heap calls cannot be counted: realtime sanitizer, and gcc's sanitizers.
bool can_count_heap_calls();

/// True under any sanitizer: it makes additional system calls and uses memory that is not locked.
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
